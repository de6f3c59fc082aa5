#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "interp/run_program.h"

namespace aircut::test {
namespace {

const std::string folder = std::string(AIRCUT_SOURCE_DIR) + "/tests/interp/errors/";

std::string read(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

Setting small_limits() {
  Setting setting;
  setting.options.limits.max_idle_blocks = 5000;
  for (const Axis axis : {Axis::x, Axis::y, Axis::z}) setting.options.axes.add(axis);
  for (const int number : {1, 2}) {
    tool::Tool tool;
    tool.number = number;
    tool.diameter = 4 * number;
    setting.tools.tools.push_back(tool);
  }
  return setting;
}

/// Some kinds need a machine whose set-up says something special.
Setting setting_for(const std::string& kind) {
  Setting setting = small_limits();
  setting.options.fanuc_subs = kind != "fanuc_subs_off";
  if (kind.starts_with("wrapped") || kind == "indexer_move") {
    setting.options.axes.add(Axis::a);
    (kind == "indexer_move" ? setting.options.indexers : setting.options.wrapped).add(Axis::a);
  }
  setting.options.retain_length_offset = kind == "retained_offset";
  if (kind == "remap_words") {
    interp::Remap remap;
    remap.code = 400;
    remap.modal_group = 10;
    remap.argspec = "P";
    remap.ngc = "body";
    remap.name = "M400";
    setting.options.remaps.push_back(remap);
    setting.files["folder/body.ngc"] = "o<body> sub\no<body> endsub\n";
  }
  return setting;
}

TEST(ErrorKinds, EachHasAProgramThatProvokesIt) {
  for (const interp::KindText& kind : interp::error_kinds()) {
    // Of the parameter file, below.
    if (std::string(kind.kind) == "parameter_order" || std::string(kind.kind) == "parameter_line")
      continue;
    const std::string path = folder + kind.kind + ".ngc";
    ASSERT_TRUE(std::filesystem::exists(path)) << path;
    SourceMap sources;
    Setting setting = setting_for(kind.kind);
    const std::string text = read(path);
    if (text.find("(! dialect fanuc)") != std::string::npos)
      setting.options.dialect = interp::Dialect::fanuc;
    if (text.find("(! dialect auto)") != std::string::npos)
      interp::choose_dialect(setting.options, text);
    const Ran ran = run_program(sources, text, setting);
    const auto& list = ran.diagnostics.list();
    const auto hit = std::find_if(list.begin(), list.end(),
                                  [&](const Diagnostic& d) { return d.kind == kind.kind; });
    ASSERT_NE(hit, list.end()) << kind.kind;
    EXPECT_EQ(list.size(), 1u) << kind.kind << " brings others with it: " << list.back().kind;
    EXPECT_TRUE(hit->span) << kind.kind << " has no place";
    EXPECT_GT(hit->message.size(), 15u) << kind.kind;
  }
}

TEST(ErrorKinds, EveryProgramBelongsToAKindAndEveryTextIsWritten) {
  std::set<std::string> known;
  for (const interp::KindText& kind : interp::error_kinds()) {
    EXPECT_TRUE(known.insert(kind.kind).second) << kind.kind << " stands twice";
    EXPECT_GT(std::string(kind.title).size(), 5u);
    EXPECT_GT(std::string(kind.text).size(), 40u);
  }
  for (const auto& file : std::filesystem::directory_iterator(folder))
    EXPECT_TRUE(known.contains(file.path().stem().string())) << file.path();
}

TEST(ErrorKinds, TheParameterFileMustAscend) {
  SourceMap sources;
  Diagnostics out;
  const auto file =
      interp::read_var(sources.add("a.var", "5161 1.5\n; text\n5163 2\n5162 3\n"), out);
  EXPECT_EQ(out.errors(), 1u);
  ASSERT_EQ(out.list().size(), 2u);
  EXPECT_EQ(out.list()[0].kind, "parameter_line");
  EXPECT_EQ(out.list()[0].span.line, 2u);
  EXPECT_EQ(out.list()[1].kind, "parameter_order");
  EXPECT_EQ(out.list()[1].span.line, 4u);
  EXPECT_EQ(file.values.at(5161), 1.5);
}

// The values are those of rs274 for the same lines.
TEST(ErrorKinds, AValueOfTheParameterFileEndsWhereTheControlEndsIt) {
  SourceMap sources;
  Diagnostics out;
  const std::string text = "5221 1o0\n5222 2 junk\n5223.0 3\n5224x 4\n\n  5225\t7\r\n5226 1e1\n";
  const auto file = interp::read_var(sources.add("a.var", text), out);
  EXPECT_EQ(file.values,
            (std::map<int, double>{{5221, 1}, {5222, 2}, {5223, 0}, {5225, 7}, {5226, 10}}));
  EXPECT_EQ(out.errors(), 0u);
  ASSERT_EQ(out.list().size(), 4u);
  for (std::uint32_t i = 0; i < 4; ++i) {
    EXPECT_EQ(out.list()[i].kind, "parameter_line");
    EXPECT_EQ(out.list()[i].span.line, i + 1);
  }
}

}  // namespace
}  // namespace aircut::test
