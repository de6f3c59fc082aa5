// Set-up files: their text as `inivar` reads it, and what `rs274 -i` makes of each key that it
// honours.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <random>
#include <utility>

#include "linuxcnc/linuxcnc.h"
#include "peer/run_alone.h"

namespace aircut::test {
namespace {

namespace fs = std::filesystem;

constexpr const char* tools = "T1 P1 Z1 D0.1\nT2 P2 Z2 D0.2\nT3 P3 Z0.5 D0.3\n";

/// Subs of the remaps below.
constexpr std::pair<const char*, const char*> subs[] = {
    {"plain.ngc",
     "o<plain> sub\n(DEBUG,1=#1 2=#2 3=#3 level=#<_call_level> remap=#<_remap_level> n=#<n> p=#<p> "
     "q=#<q> f=#<f> s=#<s> x=#<x> t=#<t>)\no<plain> endsub [7]\nM2\n"},
    {"body.ngc", "o<body> sub\n(DEBUG,x=#<x>)\nG91 G0 X1\nG90\no<body> endsub\nM2\n"},
    {"change.ngc", "o<change> sub\nG53 G0 Z0\nM6\no<change> endsub\nM2\n"},
    {"inner.ngc",
     "o<inner> sub\n(DEBUG,inner #<_remap_level> p=#<p>)\nM401\no<inner> endsub\nM2\n"},
    {"again.ngc", "o<again> sub\n(DEBUG,p=#<p>)\nM400 P2\no<again> endsub\nM2\n"},
    {"modes.ngc", "o<modes> sub\nG91\nF77\nG1 X1\n#5=3\n#<_global>=5\no<modes> endsub [3]\nM2\n"},
    {"select.ngc", "o<select> sub\nT#<t>\no<select> endsub\nM2\n"},
    {"bad.ngc", "o<bad> sub\nG1 X5 F0\no<bad> endsub\nM2\n"},
    {"a/w.ngc", "o<w> sub\n(DEBUG,in a)\no<w> endsub\nM2\n"},
    {"b/w.ngc", "o<w> sub\n(DEBUG,in b)\no<w> endsub\nM2\n"},
    {"b/w2.ngc", "o<w2> sub\n(DEBUG,w2 in b)\no<w2> endsub\nM2\n"},
};

class PeerIni : public ::testing::Test {
 protected:
  void SetUp() override {
    const char* skip = std::getenv("AIRCUT_NO_PEER");
    if (skip && std::string(skip) == "1") GTEST_SKIP() << "AIRCUT_NO_PEER=1";
    ASSERT_TRUE(reference_is_installed()) << "rs274 is not installed (Debian: linuxcnc-uspace)";
    folder_ = fs::temp_directory_path() / ("aircut_peer_ini_" + std::to_string(::getpid()));
    fs::create_directories(folder_ / "a");
    fs::create_directories(folder_ / "b");
    for (const auto& [name, text] : subs) std::ofstream(folder_ / name) << text;
  }
  void TearDown() override {
    std::error_code ignored;
    fs::remove_all(folder_, ignored);
  }

  /// The lines stand in [RS274NGC], which is the last section but those that they begin.
  void expect_same(const std::string& lines, const std::string& program_lines) {
    SCOPED_TRACE(lines + "\n" + program_lines);
    const std::string paths =
        lines.find("PATH") == std::string::npos && lines.find("PREFIX") == std::string::npos
            ? "SUBROUTINE_PATH=.\n"
            : "";
    const std::string ini =
        "[TRAJ]\nLINEAR_UNITS=inch\n[RS274NGC]\nPARAMETER_FILE=start.var\n" + paths + lines + "\n";
    std::ofstream(folder_ / "machine.ini", std::ios::binary) << ini;
    ProgramFile program;
    program.name = "program";
    for (const char c : program_lines) program.text += c == '|' ? '\n' : c;
    program.text += "\nM2\n";
    program.tools = tools;
    program.parameters.values = {{5181, 1}, {5182, 2}, {5183, 3}, {5184, 10}};
    if (lines.find("G92") != std::string::npos)
      program.parameters.values.insert({{5210, 1}, {5211, 0.5}});
    const Trace said = run_with_ini(program, folder_.string());

    SourceMap sources;
    Diagnostics out;
    const auto setup = linuxcnc::read_setup((folder_ / "machine.ini").string(),
                                            {.tools = true, .parameters = true}, sources, out);
    ASSERT_TRUE(setup.has_value());
    if (out.errors() > 0) {
      EXPECT_TRUE(said.error) << "only own refuses the set-up: " << out.list().front().message;
      return;
    }
    const interp::Options of_reference = reference_options();
    program.options = setup->options;
    program.options.machine_unit = of_reference.machine_unit;
    program.options.start_unit = of_reference.start_unit;
    program.options.axes = of_reference.axes;
    Trace own = own_trace(program, folder_.string());
    // The control looks for the words of a remap in a call that it makes itself, and shows that.
    if (own.error_text.find("[remap_words]") != std::string::npos) own.error_line = "O <";
    Trace theirs = said;
    for (Trace* trace : {&own, &theirs}) without_repeated_offsets(*trace);
    const auto what = difference(own, theirs);
    EXPECT_FALSE(what.has_value()) << *what;
  }

  // With RETAIN_G43 the reference says the offset before each line.
  static void without_repeated_offsets(Trace& trace) {
    std::string last;
    std::erase_if(trace.calls, [&](const Call& call) {
      if (!call.text.starts_with("USE_TOOL_LENGTH_OFFSET")) return false;
      return std::exchange(last, call.text) == call.text;
    });
  }

  fs::path folder_;
};

TEST_F(PeerIni, AgreesOnRemaps) {
  const std::string p = "REMAP=M400 modalgroup=10 ngc=plain argspec=";
  for (const auto& [lines, program] : std::vector<std::pair<std::string, std::string>>{
           {p + "pq", "M400|M400 P1|N5 M400 Q3|M400 P1 R3|M400 P1 L2 D3"},
           {p + "pq", "M400 P1 X3"},
           {p + "Pq", "M400 Q1"},
           {p + ">^nN", "F10 S20|N77 M400|F11 S30 M400"},
           {p + ">", "M400"},
           {p + "fst", "T1 F11 S30 M400"},
           {p + "@qpx", "M400 P1 Q2|M400 P3"},
           {p + "x", "G0 X5 M400|X2 M400|M400 X3|M400 Y3"},
           {p + "p", "#1=5 M400 P#1|(DEBUG,#1)"},
           {p + "p", "G41.1 D.1 G1 X5 F10|M400 P1|X10|Y10"},
           {p + "p",
            "o1 repeat [3]|M400 P1 G91 G0 X1|o1 endrepeat|o<s> sub|M400 P#1 G0 Y1|"
            "o<s> endsub|o<s> call [7]|o<s> call [8]"},
           {"REMAP=M400 ngc=plain modalgroup=5 argspec=p", "M400 P1 (MSG,hi)|M62 P1 M400"},
           {"REMAP=M400 ngc=plain", "M400 P1"},
           {"REMAP=m250 ngc=plain argspec=p # comment", "M250 P1"},
           {"REMAP=M6 ngc=change modalgroup=6", "T1 M6|T2 M6 G0 X1|G0 Z1 M6"},
           {"REMAP=M0 modalgroup=4 ngc=plain", "M0 G0 X1|G0 X2"},
           {"REMAP=M3 modalgroup=7 ngc=plain argspec=s", "S100 M3|G0 X1"},
           {"REMAP=T ngc=plain argspec=T", "T1|T2"},
           {"REMAP=T ngc=select argspec=t", "T1 M6|T2"},
           {"REMAP=S ngc=plain argspec=s", "S100 M3|G0 X1"},
           {"REMAP=F ngc=plain argspec=f", "F100|G1 X1"},
           {"REMAP=G88.1 ngc=body argspec=x modalgroup=1", "G88.1 X5|X7|Y8|G0 X1|G88.1|G80"},
           {"REMAP=G88.1 ngc=body argspec=x modalgroup=1", "G88.1 X5 Y2 Z3 R5 Q4 L3"},
           {"REMAP=G88.1 ngc=body argspec=X modalgroup=1", "G88.1 Y2"},
           {"REMAP=G88.1 ngc=plain argspec=p modalgroup=1", "G0 G88.1 P1"},
           {"REMAP=G81 ngc=plain argspec=p modalgroup=1", "G81 X1 Y1 Z-1 R1 F10"},
           {"REMAP=M400 ngc=again argspec=p modalgroup=10", "M400 P5"},
           {"REMAP=M400 ngc=inner argspec=p modalgroup=9\nREMAP=M401 ngc=plain argspec=pq "
            "modalgroup=10",
            "M400 M401 P5|M400 P6"},
           {"REMAP=M400 ngc=inner argspec=p\nREMAP=M401 ngc=plain", "M400 M401 P5"},
           {"REMAP=M400 ngc=modes argspec=p modalgroup=10",
            "G0 X5 F10|M400 G0 X9|(DEBUG,#5 #<_global> #<_value> #<_remap_level>)|X1"},
           {p + "p\nREMAP=M401 ngc=inner modalgroup=9\nREMAP=M0 ngc=modes modalgroup=4",
            "F5 M400 M401 M0 P3 G1 X3|X4"},
           {"REMAP=M400 ngc=bad modalgroup=10", "G0 X5|M400|G0 X6"},
           {"REMAP=M400 ngc=missing modalgroup=10", "G0 X5"},
           {"REMAP=M400 modalgroup=3 ngc=plain", "G0 X10"},
           {"REMAP=M400 modalgroup=10", "G0 X10"},
           {"REMAP=M400 ngc=plain argspec=O", "G0 X10"},
           {"REMAP=M400 ngc=plain bogus=3", "M400"},
           {"REMAP=M400 ngc=plain\nREMAP=M400 ngc=inner", "M400"},
           {"REMAP=G88.2 modalgroup=2 ngc=plain", "G0 X1"},
           {"REMAP=X ngc=plain argspec=p", "G0 X1"},
       })
    expect_same(lines, program);
}

TEST_F(PeerIni, AgreesOnWrappedAxesAndIndexers) {
  const std::string wrapped = "[AXIS_A]\nWRAPPED_ROTARY=1\n[AXIS_B]\nWRAPPED_ROTARY=1\n";
  for (const char* program :
       {"G0 A10|A350|A-350|A-0|A0|A-10|A10|A360",
        "G91 G0 A400|G90 A10|A-10|A359|A-359|G92 A5|G0 A10|A-20|G92.1|G10 L2 P1 A30|G0 A10|"
        "G0 A-340|G91 A-5|G53 G90 G0 A20|G53 G0 A-20|G1 F100 A200|G2 X10 I5 A-100|G28 A0|"
        "G0 A350 B-20",
        "G0 A90 B-90|G10 L2 P1 A30 R20 X5|G0 A0 B-0|G0 A-0|G30|G0 A40|G30.1|G28 A5|G92 A10 B20|"
        "G53 G0 A5 B-5|G28 B0",
        "G0 A720", "G53 G0 A-360"})
    expect_same(wrapped, program);
  const std::string indexers =
      "[AXIS_A]\nLOCKING_INDEXER_JOINT=3\n[AXIS_C]\nLOCKING_INDEXER_JOINT=5\nWRAPPED_ROTARY=1\n";
  for (const char* program :
       {"G0 A10|G0 X1|G0 X1 A20", "G0 A10 C20", "F10 G1 A10", "G91 G0 A0 X5", "G0 A5|G1 F10 X1",
        "G0 C-90|G0 C20|G0 C350", "G0 A5|G28", "G28 A0|G30", "G0 A5|G2 X2 I.5 A10 F10",
        "G0 A5|G81 X1 Z-1 R1 F10", "G53 G0 A10", "G0 A5|G92 A0|G0 A3", "G38.3 X1 A5 F10",
        "G28 X1 A10", "G91 G28 A10", "G61|G0 A10|G61.1|G0 A4|G0 X1", "G64 P.1 Q.2|G0 A4|G0 X1"})
    expect_same(indexers, program);
}

TEST_F(PeerIni, AgreesOnToolChanges) {
  const std::string io = "[EMCIO]\n";
  const std::string moves = "G0 X5 Y5 Z5 A5|T1 M6|G43|G0 X1|M3 S10|T2 M6|G0 X2";
  expect_same(io + "TOOL_CHANGE_AT_G30=1", moves);
  expect_same(io + "TOOL_CHANGE_QUILL_UP=1", moves);
  expect_same(io + "TOOL_CHANGE_WITH_SPINDLE_ON=1", moves);
  expect_same(io + "TOOL_CHANGE_QUILL_UP=1\nTOOL_CHANGE_AT_G30=1",
              "G0 X5 Y5 Z5 A5|G10 L2 P1 X1 Y2 Z3 R30|T1 M6|G0 X1 Z1");
  expect_same(io + "TOOL_CHANGE_AT_G30=1\n[AXIS_A]\nLOCKING_INDEXER_JOINT=3\nWRAPPED_ROTARY=1",
              "G0 X5|T1 M6|G0 X1");
  expect_same(io + "RANDOM_TOOLCHANGER=1", "T1|T2 M6|T3 M6|(DEBUG,#5400 #<_current_tool>)|T2|T7");
  expect_same("RETAIN_G43=1", "T1 M6 G43|G0 Z0|T2 M6|G0 Z3|G49|G0 Z0|T0 M6|G0 Z0|T1 M6|G0 Z0");
  expect_same("RETAIN_G43=0", "T1 M6 G43|G0 Z0|G49");
}

TEST_F(PeerIni, AgreesOnSwitchesAndTolerances) {
  for (const char* value : {"0.001", "0.0009", "0.01", "0.0283", "0.5"})
    expect_same(std::string("CENTER_ARC_RADIUS_TOLERANCE_MM=") + value,
                "G2 X10.015 Y0 I5 F10|G2 X10.2 I5");
  for (const char* value : {"0.00003", "0.00005", "0.001", "0.00283"})
    expect_same(std::string("CENTER_ARC_RADIUS_TOLERANCE_INCH=") + value,
                "G20|G2 X10.0015 Y0 I5 F10|G2 X0.01 I-5.01|G2 X10 I5");
  expect_same("DISABLE_FANUC_STYLE_SUB=1", "M98 P5|G0 X1|M2|O5|G0 X3|M99");
  expect_same("DISABLE_FANUC_STYLE_SUB=1", "G0 X1|O1|G0 X2");
  expect_same("DISABLE_FANUC_STYLE_SUB=0", "M98 P5|G0 X1|M2|O5|G0 X3|M99");
  expect_same("DISABLE_G92_PERSISTENCE=1", "G0 X0|(DEBUG,#5210 #5211)|G92 X5|(DEBUG,#5210)");
  expect_same("DISABLE_G92_PERSISTENCE=0", "G0 X0|(DEBUG,#5210 #5211)");
  expect_same("ORIENT_OFFSET=20", "M19 R90|M19 R350");
  expect_same("ORIENT_OFFSET=-30", "M19 R10");
  expect_same("OWORD_NARGS=1",
              "o<s> sub|(DEBUG,#1 #<n_args>)|o<s> endsub|o<s> call [1] [3]|o<s> call");
  expect_same("[TRAJ2]", "M3 S100 $1");
}

TEST_F(PeerIni, AgreesOnPathsAndVariables) {
  expect_same("SUBROUTINE_PATH=a:b", "o<w> call|o<w2> call");
  expect_same("SUBROUTINE_PATH=b:a", "o<w> call");
  expect_same("SUBROUTINE_PATH=none:b", "o<w> call");
  expect_same("SUBROUTINE_PATH=b\n[DISPLAY]\nPROGRAM_PREFIX=a", "o<w> call");
  expect_same("[DISPLAY]\nPROGRAM_PREFIX=a", "o<w> call|o<w2> call");
  const std::string values =
      "[S]\nK=3.5\nkey=7\nT=abc\nH=0x10\nE=\nB = 4 5\nC=1e3\nD=+2\nM=-.5\n[t]\nu=9\n[S]\nZ=1";
  expect_same(values,
              "(DEBUG,#<_ini[S]K> #<_ini[s]k> #<_ini[S]key> #<_ini[S]H> #<_ini[S]B> "
              "#<_ini[S]C> #<_ini[t]u> #<_ini[s]d> #<_ini[s]m>)");
  expect_same(values, "#1=EXISTS[#<_ini[S]K>]|#2=EXISTS[#<_ini[S]U>]|(DEBUG,#1 #2)");
  for (const char* name : {"[s]t", "[s]u", "[q]u", "[s]z"})
    expect_same(values, std::string("G0 X#<_ini") + name + ">");
  expect_same("INI_VARS=0\n" + values, "G0 X#<_ini[s]k>");
  for (const char* value : {"0", "1"})
    expect_same(std::string("HAL_PIN_VARS=") + value, "G0 X#<_hal[spindle.0.on]>");
}

// Lines put together from pieces that a reader could take in several ways.
std::string ini_by_chance(std::mt19937& random) {
  static const std::vector<std::string> pieces = {
      "[A]", "[B]",   "[A] x",   " [B]", "[C",   "[]",   "x",     "y",    "x y",  "=",
      " = ", "\t",    "1",       "a b",  "#",    " # c", ";",     "\\",   "\\\n", "\n",
      "\n",  "\nx=2", "\ny = 3", "]",    "\r\n", "\nx=", "x =4 ", "\nX=5"};
  std::string text;
  const int count = 4 + static_cast<int>(random() % 30);
  for (int i = 0; i < count; ++i) text += pieces[random() % pieces.size()];
  if (random() % 8 == 0) text += "\ny=" + std::string(250 + random() % 10, 'z') + "x=6\n";
  return text;
}

TEST_F(PeerIni, ReadsTextAsInivarDoes) {
  std::mt19937 random(7);
  int found = 0;
  for (int i = 0; i < 40; ++i) {
    const std::string text = ini_by_chance(random);
    std::ofstream(folder_ / "chance.ini", std::ios::binary) << text;
    SourceMap sources;
    Diagnostics out;
    const ini::IniFile file = ini::read_ini(sources.add("chance.ini", text), {}, out);
    for (const auto& [section, key, n] : std::vector<std::tuple<std::string, std::string, int>>{
             {"A", "x", 1}, {"A", "x", 2}, {"A", "y", 1}, {"B", "x", 1}, {"B", "y", 1}}) {
      const Said said = run_linuxcnc(
          {"inivar", "-ini", "chance.ini", "-sec", section, "-var", key, "-num", std::to_string(n)},
          folder_.string());
      const ini::Entry* entry = file.find(section, key, n);
      const std::string own = entry ? entry->value + "\n" : "";
      EXPECT_EQ(own, said.out) << text << "\n--- [" << section << "]" << key << " " << n;
      found += entry ? 1 : 0;
    }
  }
  EXPECT_GT(found, 12) << "the texts say too little";
}

TEST_F(PeerIni, ReadsTheSampleSetupsOfLinuxCncWithoutErrorsInTheirText) {
  const fs::path samples = "/usr/share/doc/linuxcnc/examples/sample-configs";
  ASSERT_TRUE(fs::exists(samples)) << samples << " is not there; it comes with linuxcnc-uspace";
  int compared = 0;
  for (const auto& file : fs::recursive_directory_iterator(samples)) {
    if (file.path().extension() != ".ini") continue;
    SourceMap sources;
    Diagnostics out;
    const auto text = sources.open(file.path().string());
    ASSERT_TRUE(text.has_value());
    if ((*text)->content().find("#INCLUDE") != std::string_view::npos) continue;
    const ini::IniFile ini = ini::read_ini(**text, {}, out);
    EXPECT_EQ(out.errors(), 0u) << file.path() << ": " << out.list().front().message;
    if (++compared % 8 != 0) continue;  // a few are compared value by value
    for (const char* key : {"COORDINATES", "LINEAR_UNITS"}) {
      const Said said = run_linuxcnc(
          {"inivar", "-ini", file.path().string(), "-sec", "TRAJ", "-var", key}, folder_.string());
      const ini::Entry* entry = ini.find("TRAJ", key);
      EXPECT_EQ(entry ? entry->value + "\n" : "", said.out) << file.path() << " " << key;
    }
  }
  EXPECT_GT(compared, 50);
}

}  // namespace
}  // namespace aircut::test
