// Machine packages from outside: any bytes, as machine.toml (whose fixtures resolve to the same
// bytes, and whose meshes to a box) and as setup.toml of a machine that is known to be good.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "machine/reading.h"

namespace {

using namespace aircut;

machine::PackageFiles files_of(const SourceText& text) {
  machine::PackageFiles files;
  files.mesh = [](const std::string&, const MeshFileOptions& options) {
    const Vec3 size = Vec3(10, 20, 30) * options.unit_mm;
    return Expected<std::shared_ptr<const TriangleMesh>>(
        std::make_shared<const TriangleMesh>(make_box(Vec3::Zero(), size)));
  };
  files.text = [&text](const std::string&) { return Expected<const SourceText*>(&text); };
  files.full_path = [](const std::string& path) { return Expected<std::string>(path); };
  return files;
}

void require(bool holds) {
  if (!holds) __builtin_trap();
}

/// Every message has a place in a text that formats.
void expect_told(const Diagnostics& out) {
  for (const Diagnostic& d : out.list()) require(!format_human(d, {}).empty());
}

/// A machine that was accepted keeps what the rest of the program relies on.
void expect_sound(const machine::Machine& m) {
  const auto links = static_cast<int>(m.links().size());
  for (const machine::Joint& joint : m.tree()) {
    require(index(joint.parent) < index(joint.child) && index(joint.child) < links);
    require(std::abs(joint.direction.norm() - 1) < 1e-9 && joint.origin.allFinite());
    if (joint.driven < 0) continue;
    require(joint.min <= joint.home && joint.home <= joint.max);
    require(joint.vmax > 0 && std::isfinite(joint.vmax) && joint.amax > 0 &&
            std::isfinite(joint.amax));
  }
  require(m.kinematics().joint_count() == m.joint_count());
  for (const machine::Body& body : m.bodies())
    require(body.mesh && !body.name.empty() && index(body.link) < links &&
            body.X_LB.matrix().allFinite());
  machine::LinkPoses poses;
  machine::forward(m, m.home(), poses);
  for (const Pose& X : poses.X_WL) require(X.matrix().allFinite());
  Diagnostics out;
  machine::check_model(m, out);
}

constexpr const char* good_machine = R"(schema = 1
name = "two axes"
[kinematics]
type = "identity"
[[axis]]
name = "X"
kind = "linear"
parent = "bed"
child = "x"
direction = [1, 0, 0]
min = -10
max = 10
vmax = 1
amax = 1
[[axis]]
name = "A"
kind = "rotary"
parent = "bed"
child = "a"
origin = [0, 0, 0]
direction = [1, 0, 0]
vmax = 1
amax = 1
[spindle]
link = "x"
gauge = [0, 0, 0]
)";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  SourceMap sources;
  const SourceText& text =
      sources.add("input", std::string(reinterpret_cast<const char*>(data), size));
  Diagnostics out;
  if (const auto m = machine::read_machine_text(text, ".", files_of(text), out)) expect_sound(**m);
  expect_told(out);

  const SourceText& good = sources.add("good", good_machine);
  Diagnostics none;
  const auto m = machine::read_machine_text(good, ".", files_of(good), none);
  require(m.has_value());
  Diagnostics more;
  if (const auto setup = machine::read_setup_text(text, **m, more))
    require(!setup->start || setup->start->allFinite());
  expect_told(more);
  return 0;
}
