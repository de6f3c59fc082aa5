#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <numbers>

#include "linuxcnc/linuxcnc.h"

namespace aircut::test {
namespace {

namespace fs = std::filesystem;

constexpr double degree = std::numbers::pi / 180;

/// Writes set-ups below a folder of its own and reads them.
class SetupFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::path(::testing::TempDir()) /
        (std::string("setup_") + ::testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::remove_all(folder_);
    fs::create_directories(folder_ / "in" / "subs");
    write("in/old.var", "5161\t1\n");
    write("in/tool.tbl", "T1 P1 Z1 D1\n");
    write("outside.var", "5161\t1\n");
  }
  void TearDown() override { fs::remove_all(folder_); }

  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  linuxcnc::Setup read(const std::string& text, linuxcnc::Given given = {}) {
    write("in/machine.ini", "[TRAJ]\nLINEAR_UNITS=mm\n" + text);
    return read_as_it_is(given);
  }
  linuxcnc::Setup read_as_it_is(linuxcnc::Given given = {}) {
    out_ = {};
    const auto setup = linuxcnc::read_setup(path("in/machine.ini"), given, sources_, out_);
    EXPECT_TRUE(setup.has_value());
    return *setup;
  }
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// `kind:line` of each message.
  std::string messages() const {
    std::string all;
    for (const Diagnostic& d : out_.list())
      all += (all.empty() ? "" : " ") + d.kind + ":" + std::to_string(d.span.line);
    return all;
  }

  fs::path folder_;
  SourceMap sources_;
  Diagnostics out_;
};

TEST_F(SetupFile, OfTheSampleGivesEveryOption) {
  const auto setup =
      linuxcnc::read_setup(AIRCUT_SOURCE_DIR "/tests/data/ini/mill/mill.ini", {}, sources_, out_);
  ASSERT_TRUE(setup.has_value());
  EXPECT_EQ(messages(), "");
  const interp::Options& o = setup->options;
  EXPECT_EQ(o.machine_unit, canon::Unit::millimetre);
  EXPECT_EQ(o.arc_tolerance, 0.005);
  EXPECT_EQ(o.arc_tolerance_inch, 0.00283);
  EXPECT_EQ(o.g73_clearance, 0.5);
  EXPECT_EQ(o.g83_clearance, 0.75);
  EXPECT_EQ(o.orient_offset, 12.5);
  EXPECT_TRUE(o.tool_change_quill_up);
  EXPECT_FALSE(o.tool_change_at_g30);
  EXPECT_TRUE(o.wrapped.has(Axis::a));
  EXPECT_TRUE(o.indexers.has(Axis::a));
  EXPECT_TRUE(o.axes.has(Axis::a));
  EXPECT_FALSE(o.axes.has(Axis::b));
  EXPECT_EQ(o.ini.at("POCKET/DEPTH"), 7.5);
  EXPECT_EQ(o.startup_line.covered(), "G17 G21 G40 G49 G64 P0.02 G80 G90 G94");
  ASSERT_EQ(o.remaps.size(), 2u);
  EXPECT_EQ(o.remaps[0].name, "M400");
  EXPECT_EQ(o.remaps[0].argspec, "Pq");
  EXPECT_EQ(o.remaps[0].ngc, "touch");
  EXPECT_EQ(o.remaps[1].modal_group, 6);
  ASSERT_EQ(o.sub_path.size(), 2u);
  EXPECT_TRUE(o.sub_path[1].ends_with("/mill/subs"));
  EXPECT_TRUE(setup->parameter_file.ends_with("/mill/mill.var"));
  EXPECT_TRUE(setup->tool_table.ends_with("/mill/mill.tbl"));
  EXPECT_EQ(*setup->travel.at(Axis::z).max, 0.5);
  EXPECT_EQ(*setup->travel.at(Axis::a).min, -36000 * degree);
  EXPECT_TRUE(setup->unchecked.empty());
}

TEST_F(SetupFile, CountsLengthsInItsUnit) {
  write("in/machine.ini",
        "[TRAJ]\nLINEAR_UNITS = inch\n[RS274NGC]\nG73_PECK_CLEARANCE=0.1\n"
        "[EMCIO]\nTOOL_CHANGE_POSITION = 1 2 3 90 0 0\n[AXIS_X]\nMAX_LIMIT=2\n");
  const auto setup = read_as_it_is();
  EXPECT_EQ(messages(), "");
  EXPECT_EQ(setup.unit_mm, 25.4);
  EXPECT_EQ(setup.options.start_unit, canon::Unit::inch);
  EXPECT_DOUBLE_EQ(setup.options.g73_clearance, 2.54);
  EXPECT_DOUBLE_EQ(*setup.travel.at(Axis::x).max, 50.8);
  ASSERT_TRUE(setup.options.tool_change_position.has_value());
  const auto& [axes, position] = *setup.options.tool_change_position;
  EXPECT_TRUE(axes.has(Axis::c));
  EXPECT_FALSE(axes.has(Axis::u));
  EXPECT_DOUBLE_EQ(position[Axis::y], 50.8);
  EXPECT_DOUBLE_EQ(position[Axis::a], 90 * degree);
}

TEST_F(SetupFile, TakesSwitchesOnlyWhenEveryVersionReadsThemAlike) {
  const auto setup = read("[RS274NGC]\nRETAIN_G43=1\nDISABLE_G92_PERSISTENCE=1\nINI_VARS=0\n");
  EXPECT_TRUE(setup.options.retain_length_offset);
  EXPECT_FALSE(setup.options.keep_g92);
  EXPECT_FALSE(setup.options.ini_variables);
  EXPECT_EQ(messages(), "");
  read("[RS274NGC]\nRETAIN_G43=yes\nINI_VARS=0 # off\n");
  EXPECT_EQ(messages(), "ini_value:5 ini_value:4");
  EXPECT_EQ(out_.errors(), 2u);
}

TEST_F(SetupFile, KeepsTheDefaultForATolerancesThatTheControlRefuses) {
  const auto setup = read("[RS274NGC]\nCENTER_ARC_RADIUS_TOLERANCE_MM=0.5\n");
  EXPECT_EQ(setup.options.arc_tolerance, 0.0283);
  EXPECT_EQ(messages(), "ini_ignored:4");
}

TEST_F(SetupFile, StaysInItsFolder) {
  for (const char* name :
       {"/etc/hostname", "../outside.var", "subs/../../outside.var", "~/x", "$HOME/x", "`id`"}) {
    const auto setup = read(std::string("[RS274NGC]\nPARAMETER_FILE=") + name + "\n");
    EXPECT_EQ(messages(), "path_refused:4") << name;
    EXPECT_EQ(setup.parameter_file, "") << name;
  }
  fs::create_symlink(folder_ / "outside.var", folder_ / "in" / "link.var");
  read("[RS274NGC]\nPARAMETER_FILE=link.var\n");
  EXPECT_EQ(messages(), "path_refused:4");
  read("#INCLUDE ../outside.var\n");
  EXPECT_EQ(messages(), "path_refused:3");
  read("[RS274NGC]\nPARAMETER_FILE=subs\n");
  EXPECT_EQ(messages(), "input:4") << "a folder";
  const auto setup = read("[RS274NGC]\nPARAMETER_FILE=old.var\n");
  EXPECT_EQ(setup.parameter_file, path("in/old.var"));
  EXPECT_EQ(messages(), "");
}

TEST_F(SetupFile, DoesNotLookAtFilesThatTheUserReplaces) {
  const std::string text = "[RS274NGC]\nPARAMETER_FILE=/a\n[EMCIO]\nTOOL_TABLE=/b\n";
  read(text, {.tools = true, .parameters = true});
  EXPECT_EQ(messages(), "");
  EXPECT_EQ(read(text).unchecked.size(), 2u);
  EXPECT_EQ(messages(), "path_refused:4 path_refused:6");
}

TEST_F(SetupFile, StartsWithoutTheParametersThatTheControlHasNotWrittenYet) {
  const auto setup = read("[RS274NGC]\nPARAMETER_FILE=new.var\n");
  EXPECT_EQ(messages(), "ini_ignored:4");
  EXPECT_EQ(setup.parameter_file, "");
  EXPECT_TRUE(setup.unchecked.empty());
}

TEST_F(SetupFile, OnlyWarnsOfAFolderOfSubsThatItMayNotSearch) {
  const auto setup =
      read("[DISPLAY]\nPROGRAM_PREFIX=../../nc_files\n[RS274NGC]\nSUBROUTINE_PATH=none:subs\n");
  EXPECT_EQ(messages(), "path_refused:4 ini_ignored:6");
  EXPECT_EQ(out_.errors(), 0u);
  EXPECT_EQ(setup.options.sub_path, std::vector<std::string>{path("in/subs")});
}

TEST_F(SetupFile, TellsMisspeltKeysAndSections) {
  read(
      "[RS274NGC]\nRETAIN_G34=1\nsubroutine_path=subs\nMY_OWN_KEY=1\n[AXIS_A]\nWRAPED_ROTARY=1\n"
      "[EMCI0]\n[JOINT_0]\nSTEPGEN_MAXACCEL=3\nMAX_LIMT=4\n");
  EXPECT_EQ(messages(), "ini_key:4 ini_key:5 ini_key:8 ini_key:9 ini_key:12");
  EXPECT_NE(out_.list()[0].message.find("RETAIN_G43"), std::string::npos);
  EXPECT_NE(out_.list()[3].message.find("[EMCIO]"), std::string::npos);
}

TEST_F(SetupFile, LeavesNothingThatChangesTheMotionUnsaid) {
  const auto setup = read(
      "[AXIS_X]\nOFFSET_AV_RATIO=0.2\n[RS274NGC]\nNO_DOWNCASE_OWORD=1\n"
      "ON_ABORT_COMMAND=o<x> call\n[EMCIO]\nDB_PROGRAM=./tools.py\n");
  EXPECT_EQ(setup.unchecked.size(), 3u);
  EXPECT_EQ(messages(), "not_executed:9 ini_not_modelled:7 ini_not_modelled:6 ini_not_modelled:4");
}

TEST_F(SetupFile, WithoutAUnitIsNotKnownWell) {
  write("in/machine.ini", "[TRAJ]\nSPINDLES=1\n");
  EXPECT_EQ(read_as_it_is().unchecked.size(), 1u);
}

TEST_F(SetupFile, WithValuesOutOfRangeIsRefused) {
  read(
      "ANGULAR_UNITS=radian\nCOORDINATES=X Q\nSPINDLES=9\n[RS274NGC]\nG83_PECK_CLEARANCE=-1\n"
      "[EMCIO]\nTOOL_CHANGE_POSITION=1 2\n[AXIS_X]\nMIN_LIMIT=5\nMAX_LIMIT=4\n");
  EXPECT_EQ(messages(), "ini_value:3 ini_value:5 ini_value:4 ini_value:7 ini_value:9 ini_value:11");
}

class RemapLine : public ::testing::Test {
 protected:
  std::optional<interp::Remap> read(const std::string& value) {
    out_ = {};
    const SourceText& text = sources_.add("m.ini", "REMAP=" + value);
    return linuxcnc::read_remap(value, {&text, 6, static_cast<std::uint32_t>(value.size()), 1},
                                out_);
  }
  std::string message() const {
    return out_.list().empty() ? ""
                               : out_.list().front().kind + " at " +
                                     std::string(out_.list().front().span.covered());
  }

  SourceMap sources_;
  Diagnostics out_;
};

TEST_F(RemapLine, IsReadAsTheControlReadsIt) {
  const auto remap = read("g88.1  modal=1 arg=@Xp\tngc=Cycle # modalgroup=4");
  ASSERT_TRUE(remap.has_value());
  EXPECT_EQ(remap->letter, 'G');
  EXPECT_EQ(remap->code, 881);
  EXPECT_EQ(remap->argspec, "@Xp");
  EXPECT_EQ(remap->ngc, "cycle");
  EXPECT_EQ(message(), "");
  EXPECT_EQ(read("M250 ngc=a")->modal_group, 10);
  EXPECT_EQ(read("T prolog=p ngc=a epilog=e")->python, "prolog=p epilog=e");
}

TEST_F(RemapLine, IsRefusedAtTheWordThatIsWrong) {
  for (const auto& [value, expected] : std::vector<std::pair<std::string, std::string>>{
           {"", "ini_remap at "},
           {"M400 modalgroup=10", "ini_remap at M400"},
           {"M400 modalgroup=3 ngc=a", "ini_remap at M400"},
           {"M400 ngc=a python=b", "ini_remap at python=b"},
           {"M400 argspec=O ngc=a", "ini_remap at argspec=O"},
           {"M400 ngc=", "ini_remap at ngc="},
           {"M400 ngc", "ini_remap at ngc"},
           {"Mx ngc=a", "ini_remap at Mx"},
           {"G88.12 ngc=a", "ini_remap at G88.12"},
           {"G88.1 modalgroup=2 ngc=a", "ini_remap at G88.1"},
           {"T1 ngc=a", "ini_remap at T1"},
           {"S modalgroup=6 ngc=a", "ini_remap at S"}}) {
    EXPECT_FALSE(read(value).has_value()) << value;
    EXPECT_EQ(message(), expected) << value;
    EXPECT_GT(out_.errors(), 0u) << value;
  }
}

TEST_F(RemapLine, OfACodeThatCantBeRemappedIsPassedOverWithAWarning) {
  for (const char* value :
       {"M3 modalgroup=7 ngc=a", "G81 modalgroup=1 ngc=a", "X ngc=a", "G300 ngc=a"}) {
    EXPECT_FALSE(read(value).has_value()) << value;
    EXPECT_EQ(out_.errors(), 0u) << value;
    EXPECT_EQ(out_.list().size(), 1u) << value;
  }
  EXPECT_TRUE(read("M400 ngc=a modalgruop=10").has_value());
  EXPECT_EQ(message(), "ini_ignored at modalgruop=10");
}

}  // namespace
}  // namespace aircut::test
