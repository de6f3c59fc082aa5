// `aircut kin rot`: conventions, frames and heads through the command line.
#include <gtest/gtest.h>

#include <cmath>

#include "kin_program.h"

namespace aircut {
namespace {

// All numbers of a text, near to the wanted ones.
void expect_numbers(const std::string& text, const std::vector<double>& wanted) {
  std::istringstream words(text);
  std::vector<double> got;
  for (std::string word; words >> word;)
    if (word.find_first_not_of("-0123456789.e") == word.npos) got.push_back(std::stod(word));
  ASSERT_EQ(got.size(), wanted.size()) << text;
  for (std::size_t i = 0; i < got.size(); ++i) EXPECT_NEAR(got[i], wanted[i], 1e-8) << text;
}

TEST_F(Kin, RotConvertsBetweenConventions) {
  expect_numbers(kin("rot --from XYZ-ext --to 57-int", "30 45 60\n").out,
                 {-24.597222684, 47.663220464, 58.334492452});
  expect_numbers(
      kin("rot --from XYZ-ext --to ZXY-ext --inverse", "ANG_3=60 ANG_1=30 ANG_2=45\n").out,
      {39.639272238, -16.279906247, 50.360727762, -140.360727762, -163.720093753, -129.639272238});
  const Outcome all = kin("rot --from matrix --to all", "0 -1 0 1 0 0 0 0 1\n");
  EXPECT_NE(all.out.find("ZYX-ext 90 0 0\n"), std::string::npos) << all.out;
  expect_numbers(kin("rot --to matrix", "0 0 90\n").out, {0, -1, 0, 1, 0, 0, 0, 0, 1});
}

TEST_F(Kin, RotComposesFrames) {
  const Outcome r = kin("rot --frame --add", "10 0 0 0 0 90 5 0 0\n1 0 0 90 0 0 0 0 0\n");
  expect_numbers(r.out, {10, 5, 0, 0, 0, 90, 10, 6, 0, 90, 90, 0});
}

TEST_F(Kin, RotPointsHeadsAndTables) {
  const Outcome head = kin("rot --to head", "0 30 0\n");
  EXPECT_NE(head.out.find(" ; "), std::string::npos) << head.out;
  const auto first = rows_of(head.out).at(0);
  EXPECT_NEAR(std::abs(first.at(0)), 90, 1e-8);
  EXPECT_NEAR(std::abs(first.at(1)), 30, 1e-8);
  EXPECT_NEAR(first.at(0) * first.at(2), -8100, 1e-5);  // what C turns is left as roll
  const auto table = rows_of(kin("rot --to table", "0 30 0\n").out).at(0);
  ASSERT_EQ(table.size(), 3u);
  EXPECT_NEAR(std::abs(table.at(2)), 30, 1e-4);
  const Outcome down = kin("rot --to head45", "180 0 0\n");
  EXPECT_EQ(down.out, "error: the head can't point the tool there\n");
  EXPECT_EQ(down.code, 1);
}

TEST_F(Kin, RotRunsTheCycle) {
  const Outcome r = kin("rot --cycle",
                        "CYCLE600(0,\"IFVW207\",1,57,0,0,0,30,45,60,0,0,0,0,39,0,0,0)\n"
                        "0,H,1,57,0,0,0,30,45,60,0,0,0,0,0,39,0,0,0\n");
  EXPECT_EQ(r.code, 1);
  const std::size_t line = r.out.find('\n');
  EXPECT_TRUE(r.out.starts_with("IFVW207 ")) << r.out;
  expect_numbers(r.out.substr(0, line),
                 {39.639272238, -16.279906247, 50.360727762, 0, 39, 0, 0, 0});
  EXPECT_EQ(r.out.substr(line + 1),
            "error: CYCLE600 has 18 arguments, from _INEXIN to _RETR_Z; this call has 19\n");
}

TEST_F(Kin, RotSaysWhatItDoesNotUnderstand) {
  const Outcome r = kin("rot --from XZX-int", "1 2 3\n");
  EXPECT_EQ(r.code, 2);
  EXPECT_NE(r.err.find("'XZX-int' is no rotation convention"), std::string::npos) << r.err;
  EXPECT_EQ(kin("rot --from matrix", "2 0 0 0 1 0 0 0 1\n").code, 1);
  EXPECT_EQ(kin("rot --cycle --add", "1\n").code, 2);
}

}  // namespace
}  // namespace aircut
