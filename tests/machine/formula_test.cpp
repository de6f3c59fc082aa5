// Structural formulas: the parses of the vectors, what is refused and where, the way there and
// back, and packages made from them.
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "base/random.h"
#include "machine/formula/new_package.h"
#include "machine/machine.h"
#include "machine/reading.h"

namespace aircut::machine {
namespace {

nlohmann::json vectors() {
  std::ifstream file(std::string(AIRCUT_SOURCE_DIR) + "/tests/data/structural_formulas.json");
  return nlohmann::json::parse(file);
}

FormulaBranch branch_of(const nlohmann::json& couples) {
  FormulaBranch branch;
  for (const auto& c : couples)
    branch.push_back({c.at("kind") == "R", c.at("element"),
                      c.at("axis").is_null() ? "" : c.at("axis").get<std::string>()});
  return branch;
}

Formula wanted_of(const nlohmann::json& chains) {
  Formula formula;
  for (const auto& c : chains) {
    FormulaChain chain{branch_of(c.at("workpiece")), {}};
    for (const auto& tool : c.at("tools")) chain.tools.push_back(branch_of(tool));
    formula.chains.push_back(chain);
  }
  return formula;
}

Formula parsed(const std::string& text) {
  const auto formula = parse_formula(text);
  EXPECT_TRUE(formula) << text << ": " << formula.error().message;
  return formula ? *formula : Formula{};
}

TEST(Formula, ParsesTheVectors) {
  ASSERT_EQ(vectors().at("vectors").size(), 9u);
  for (const auto& v : vectors().at("vectors")) {
    const Formula formula = parsed(v.at("formula"));
    EXPECT_EQ(formula, wanted_of(v.at("chains"))) << v.at("formula") << text_of(formula);
    EXPECT_EQ(parsed(text_of(formula)), formula) << text_of(formula);
  }
  for (const auto& text : vectors().at("invalid"))
    EXPECT_FALSE(parse_formula(text.get<std::string>())) << text;
}

TEST(Formula, SaysWhereItIsWrong) {
  const auto expect = [](const char* text, std::size_t column, const char* part) {
    const auto formula = parse_formula(text);
    ASSERT_FALSE(formula) << text;
    EXPECT_EQ(formula.error().column, column) << text << ": " << formula.error().message;
    EXPECT_NE(formula.error().message.find(part), std::string::npos)
        << text << ": " << formula.error().message;
  };
  expect("R(MS)-T(LS)", 12, "bed O");
  expect("R(MS)-O-T(LS)-O", 15, "stands twice");
  expect("R(MS)-O-T(QQ)", 11, "no element 'QQ'");
  expect("R(MS)-O-R(SS)", 9, "both sides");
  expect("X(MS)-O", 1, "expected a couple");
  expect("", 1, "expected a couple");
  expect("O", 1, "needs a couple");
  expect("R(MS)-O-T(LS:C)", 14, "sliding couple has an axis X");
  expect("R(MS:X)-O", 6, "turning couple has an axis A");
  expect("R(MS)-O-T(LS:Z)-T(TS:Z)", 17, "stands twice");
  expect("R(LS)-O", 1, "slides unless");
  expect("R(MS)-O-{T(LS)|T(TS)", 21, "'}'");
  expect("R(MS)-O-T(LS) ", 14, "';'");
  expect("R(MS)-O-T(LS", 13, "')'");
  expect("{R(MS)|T(LS)}-O-T(TS)", 1, "one branch");
  expect("Wp-R(MS)-O-T(TS)-Wp", 1, "both ends");
}

TEST(Formula, FillsInAxesThatAreNotNamed) {
  EXPECT_EQ(text_of(parsed("R(MS)-O-T(LS)-T(TS)")), "R(MS:C)-O-T(LS:Z)-T(TS:X)");
  EXPECT_EQ(text_of(parsed("R(MS)-O-{T(LS)-T(TS)|T(LS)-T(TS)}")),
            "R(MS:C)-O-{T(LS:Z1)-T(TS:X1)|T(LS:Z2)-T(TS:X2)}");
  EXPECT_EQ(text_of(parsed("R(MS)-O-T(LS3)-T(TS)-R(RH)")), "R(MS:C)-O-T(LS3:Z3)-T(TS:X)-R(RH)");
}

TEST(Formula, MarksDecideWhichSideIsTheWorkpieces) {
  const Formula a = parsed("T(TS:X)-O-T(LS:Z)"), b = parsed("T-T(TS:X)-O-T(LS:Z)-Wp");
  EXPECT_EQ(a.chains[0].work[0].axis, "X");
  EXPECT_EQ(b.chains[0].work[0].axis, "Z");
  const Formula c = parsed("Wp-T(LS:Z)-O-R(RT:C)");
  EXPECT_EQ(c.chains[0].work[0].axis, "Z");
  EXPECT_EQ(parsed(text_of(c)), c);
}

// Random machines, written and read again.
TEST(Formula, ComesBackFromItsText) {
  Random random(81);
  const std::array<const char*, 9> kinds = {"MS", "SS", "LS", "TS", "VS", "RS", "RH", "HA", "RT"};
  for (int i = 0; i < 20000; ++i) {
    Formula formula;
    int number = 0;
    const auto branch = [&](bool may_hold) {
      FormulaBranch out;
      for (std::uint64_t n = random.next() % 4; n > 0; --n) {
        const std::string kind = kinds[random.next() % 9];
        const bool holds = kind == "MS" || kind == "SS" || kind == "RT";
        if (holds && !may_hold) continue;
        ++number;
        const bool rotary = holds || kind[0] == 'R' || kind == "HA";
        const std::string letter(1, (rotary ? "ABC" : "XYZ")[random.next() % 3]);
        out.push_back({rotary, kind + (random.next() % 2 ? std::to_string(number) : ""),
                       kind == "RH"                        ? ""
                       : kind == "MS" && random.next() % 2 ? "S"
                                                           : letter + std::to_string(number)});
      }
      return out;
    };
    for (std::uint64_t chains = 1 + random.next() % 3; chains > 0; --chains) {
      FormulaChain chain{branch(true), {}};
      const std::uint64_t tools = 1 + random.next() % 3;
      for (std::uint64_t t = 0; t < tools; ++t) {
        FormulaBranch tool = branch(chain.work.empty() ? false : random.next() % 4 == 0);
        if (tool.empty() && tools > 1)
          tool.push_back({false, "LS", "W" + std::to_string(++number)});
        chain.tools.push_back(tool);
      }
      if (chain.work.empty() && chain.tools[0].empty()) chain.work.push_back({true, "MS", "S"});
      // RS has no axis of its own: one that is left out is read as none.
      formula.chains.push_back(chain);
    }
    const std::string text = text_of(formula);
    const auto again = parse_formula(text);
    ASSERT_TRUE(again) << text << ": " << again.error().message;
    ASSERT_EQ(*again, formula) << text << " / " << text_of(*again);
  }
}

// ---- packages ---------------------------------------------------------------------------------

std::shared_ptr<const Machine> machine_of(const std::vector<PackageFile>& files, SourceMap& sources,
                                          std::string& problems) {
  std::map<std::string, std::string> bytes;
  for (const PackageFile& f : files) bytes[f.path] = f.bytes;
  PackageFiles access;
  access.mesh =
      [bytes](const std::string& path,
              const MeshFileOptions& options) -> Expected<std::shared_ptr<const TriangleMesh>> {
    auto mesh = read_mesh_bytes(bytes.at(path), path, options);
    if (!mesh) return unexpected(mesh.error());
    return std::make_shared<const TriangleMesh>(std::move(*mesh));
  };
  access.text = [](const std::string& path) -> Expected<const SourceText*> {
    return unexpected(make_error("input", path));
  };
  access.full_path = [](const std::string& path) { return Expected<std::string>(path); };
  Diagnostics out;
  const SourceText& text = sources.add("machine.toml", bytes.at("machine.toml"));
  const auto machine = read_machine_text(text, ".", access, out);
  if (machine) check_model(**machine, out);
  for (const Diagnostic& d : out.list()) problems += format_gcc(d) + "\n";
  return machine ? *machine : nullptr;
}

TEST(NewPackage, IsReadWithoutAComplaint) {
  std::vector<std::string> formulas;
  for (const auto& v : vectors().at("vectors")) formulas.push_back(v.at("formula"));
  formulas.insert(formulas.end(),
                  {"R(RT:C)-R(RT1:A)-O-T(TS:X)-T(PS:Y)-T(LS:Z)", "T(PS:Y)-T(TS:X)-O-T(VS:Z)",
                   "T(TS:X)-O-T(PS:Y)-T(VS:Z)-R(HD:B)", "O-T(TS:X)-T(LS:Z)",
                   "R(MS)-O-{T(LS)-T(TS)|T(LS)-T(TS)}", "R(MS:S)-O-T(LS:Z)-T(PS:Y)-T(TS:X)"});
  for (const std::string& text : formulas) {
    SCOPED_TRACE(text);
    const auto files = package_of(parsed(text), "test");
    ASSERT_TRUE(files) << files.error();
    SourceMap sources;
    std::string problems;
    const auto machine = machine_of(*files, sources, problems);
    EXPECT_TRUE(machine);
    EXPECT_EQ(problems, "");
    if (!machine) continue;
    int axes = 0;
    for (const FormulaChain& chain : parsed(text).chains) {
      const auto count = [&](const FormulaBranch& branch) {
        for (const FormulaCouple& c : branch) axes += !c.axis.empty() && !c.is_spindle();
      };
      count(chain.work);
      for (const FormulaBranch& tool : chain.tools) count(tool);
    }
    EXPECT_EQ(machine->joint_count(), axes);
  }
}

TEST(NewPackage, SaysWhatItCannotHold) {
  const auto why = [](const char* text) {
    const auto files = package_of(parsed(text), "test");
    return files ? std::string("made") : files.error();
  };
  EXPECT_NE(why("R(MS:S)-O").find("no NC axis"), std::string::npos);
  EXPECT_NE(why("T(LS:Z1)-O-T(LS:Z2)").find("another axis has already"), std::string::npos);
  EXPECT_NE(why("R(MS:C1)-R(RT:C2)-R(RT:C3)-R(RT:C4)-O").find("no program word is left"),
            std::string::npos);
}

}  // namespace
}  // namespace aircut::machine
