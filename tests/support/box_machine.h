// A three-axis machine made of boxes, written as a package into a temporary folder: X carries Y
// carries Z carries a post of 10 x 10 x 20 mm whose lower face centre is the gauge point, at the
// origin with all joints at zero. A plate 0.02 mm thick stands at X 50, Y ±50, Z 0 … 50.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include "machine/machine.h"

namespace aircut::testing {

class BoxMachine {
 public:
  explicit BoxMachine(const std::string& more_toml = "") {
    std::string name = (std::filesystem::temp_directory_path() / "aircut-box-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    std::filesystem::create_directory(folder_ + "/meshes");
    put("meshes/post.stl", stl_bytes(make_box(Vec3(-5, -5, 0), Vec3(5, 5, 20))));
    put("meshes/plate.stl", stl_bytes(make_box(Vec3(50, -50, 0), Vec3(50.02, 50, 50))));
    put("meshes/block.stl", stl_bytes(make_box(Vec3(-20, -120, -10), Vec3(20, -80, 30))));
    std::string toml =
        "schema = 1\nname = \"boxes\"\nunits = \"mm\"\n[kinematics]\ntype = \"identity\"\n"
        "[spindle]\nlink = \"z\"\ngauge = [0.0, 0.0, 0.0]\n";
    const char* parents[] = {"bed", "x", "y"};
    const char* axes[] = {"X", "Y", "Z"};
    const char* links[] = {"x", "y", "z"};
    const char* directions[] = {"[1.0, 0.0, 0.0]", "[0.0, 1.0, 0.0]", "[0.0, 0.0, 1.0]"};
    for (int i = 0; i < 3; ++i)
      toml += "[[axis]]\nname = \"" + std::string(axes[i]) + "\"\nkind = \"linear\"\nparent = \"" +
              parents[i] + "\"\nchild = \"" + links[i] + "\"\ndirection = " + directions[i] +
              "\nmin = -200.0\nmax = 200.0\nvmax = 500.0\namax = 5000.0\nhome = 0.0\n";
    toml +=
        "[[body]]\nname = \"post\"\nrole = \"spindle\"\nlink = \"z\"\nmesh = \"meshes/post.stl\"\n"
        "[[body]]\nname = \"plate\"\nlink = \"bed\"\nmesh = \"meshes/plate.stl\"\n" +
        more_toml;
    put("machine.toml", toml);
    Diagnostics out;
    const auto read = machine::read_machine(folder_, sources_, out);
    for (const Diagnostic& d : out.list()) ADD_FAILURE() << format_human(d, {});
    if (read) machine_ = *read;
  }
  ~BoxMachine() { std::filesystem::remove_all(folder_); }
  BoxMachine(const BoxMachine&) = delete;
  BoxMachine& operator=(const BoxMachine&) = delete;

  std::shared_ptr<const machine::Machine> machine() const { return machine_; }
  SourceMap& sources() { return sources_; }
  const std::string& folder() const { return folder_; }

 private:
  void put(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ + "/" + name, std::ios::binary) << bytes;
  }
  std::string folder_;
  SourceMap sources_;
  std::shared_ptr<const machine::Machine> machine_;
};

}  // namespace aircut::testing
