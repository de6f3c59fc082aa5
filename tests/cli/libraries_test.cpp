// The libraries that draw are opened when a picture is drawn: everything else works without them.

#include "cli/program.h"

namespace aircut {
namespace {

/// Files that are found before the libraries of these names and can't be loaded.
class BrokenLibraries : public Program {
 protected:
  void break_library(const std::string& name) {
    put(name, "this is not a library");
    environment_ = "LD_LIBRARY_PATH=" + folder_.string();
  }
};

TEST_F(BrokenLibraries, AreNotNeededToReadPrograms) {
  break_library("libOSMesa.so.8");
  break_library("libEGL.so.1");
  put("p.ngc", "G21\nG0 X1\nM2\n");
  EXPECT_EQ(aircut("check " + path("p.ngc")).code, 0);
  EXPECT_EQ(aircut("trace " + path("p.ngc")).code, 0);
  EXPECT_EQ(aircut("run " + path("p.ngc") + " -m mill3").code, 0);
  EXPECT_EQ(aircut("explain overtravel").code, 0);
  EXPECT_EQ(aircut("kin fk -m mill3", "0 0 0\n").code, 0);
}

TEST_F(BrokenLibraries, AreNamedWhenAPictureIsWanted) {
  break_library("libOSMesa.so.8");
  break_library("libEGL.so.1");
  const Outcome doctor = aircut("doctor");
  EXPECT_EQ(doctor.code, 2);
  EXPECT_TRUE(doctor.says("can't open libOSMesa.so.8")) << doctor.out;
  EXPECT_TRUE(doctor.says("can't open libEGL.so.1")) << doctor.out;
  const Outcome picture = aircut("machine render mill3 -o " + path("m.png"));
  EXPECT_EQ(picture.code, 2);
  EXPECT_TRUE(picture.says("install libosmesa6")) << picture.err;
  EXPECT_TRUE(picture.says("install libegl1")) << picture.err;
}

TEST_F(BrokenLibraries, AreReplacedByTheOtherBackEnd) {
  break_library("libOSMesa.so.8");
  const Outcome doctor = aircut("doctor");
  if (doctor.says("EGL: can't")) GTEST_SKIP() << doctor.out;
  EXPECT_EQ(doctor.code, 0);
  const Outcome picture = aircut("machine render mill3 -o " + path("m.png"));
  EXPECT_EQ(picture.code, 0) << picture.err;
  EXPECT_GT(std::filesystem::file_size(path("m.png")), 1000u);
}

}  // namespace
}  // namespace aircut
