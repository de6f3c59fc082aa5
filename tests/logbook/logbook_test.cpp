// Logs written by hand, so that what is right is known without any other part of the program.
#include "logbook/logbook.h"

#include <gtest/gtest.h>

#include <cmath>

namespace aircut::logbook {
namespace {

// X and Y of a machine with 100 mm/s, 1000 mm/s², 20000 mm/s³.
struct Written {
  std::string rows;
  std::size_t count = 0;
  std::uint64_t block = 1;
  double feed = 0;
  bool at_rest = false;

  void add(double x, double y, double v = 0) {
    const auto number = [](double value) { return "," + shortest(value); };
    const std::string b = std::to_string(block);
    rows += shortest(static_cast<double>(count) * 0.001) + "," + b + "," + b + ",2" + number(feed) +
            number(v) + ",0";
    for (const double value : {x, y, v, 0.0, 0.0, 0.0, x, y}) rows += number(value);
    rows += ",0,0,0,0,0,0,0,1,0,0,0,4\n";
    ++count;
  }
  std::string text(const std::string& more = "") const {
    return "# format=aircut-joints-1\n# program=part.ngc\n# machine=mill\n# servo_period_s=0.001\n"
           "# every=1\n# joints=X:mm,Y:mm\n# limits_v=100,100\n# limits_a=1000,1000\n"
           "# limits_j=20000,inf\n# end_time_s=" +
           shortest(static_cast<double>(count - 1) * 0.001) +
           "\n# samples=" + std::to_string(count) + "\n" + more +
           "t,line,block,motion,feed_cmd,feed_act,s,q0,q1,v0,v1,a0,a1,x,y,z,a,b,c,u,v,w,tool,"
           "spindle_rpm,spindle_rev,sync_error,flags\n" +
           rows;
  }
};

// From rest to rest along X by way: jerk j, −j, −j, j for T each; peak acceleration j T.
Written move_of(double jerk, double ramp, double feed = 100) {
  Written out;
  out.feed = feed;
  const double end = 4 * ramp;
  for (int k = 0; k * 0.001 < end + 1e-9; ++k) {
    double t = 0, x = 0, v = 0, a = 0;
    for (int phase = 0; phase < 4; ++phase) {
      const double j = phase == 0 || phase == 3 ? jerk : -jerk;
      const double d = std::min(ramp, k * 0.001 - t);
      if (d <= 0) break;
      x += d * (v + d * (a / 2 + d * j / 6));
      v += d * (a + d * j / 2);
      a += d * j;
      t += d;
    }
    out.add(x, 0, k * 0.001 > end - 1e-9 ? 0 : v);
  }
  return out;
}

Expected<Check> check_text(const std::string& text, const IdealPath& path = {}) {
  const SourceText source("joints.csv", text);
  return check(source, path);
}

const Peak& peak(const Check& check, const std::string& what, const std::string& joint) {
  for (const Peak& p : check.peaks)
    if (p.what == what && p.joint == joint) return p;
  static const Peak none;
  return none;
}

IdealPath pieces(std::vector<IdealPiece> list) {
  return [list, i = std::size_t{0}](IdealPiece& out) mutable {
    if (i == list.size()) return false;
    out = list[i++];
    return true;
  };
}

TEST(Logbook, MeasuresJerkAndAccelerationByDifferences) {
  const auto good = check_text(move_of(20000, 0.04).text());
  ASSERT_TRUE(good) << good.error().message;
  EXPECT_TRUE(good->problems.empty());
  EXPECT_NEAR(peak(*good, "jerk", "X").share, 1, 1e-6);
  EXPECT_EQ(peak(*good, "jerk", "X").rows_over, 0u);
  EXPECT_NEAR(peak(*good, "acceleration", "X").share, 0.8, 0.02);
  EXPECT_EQ(peak(*good, "jerk", "Y").share, 0);
  const auto bad = check_text(move_of(20040, 0.04).text());
  ASSERT_TRUE(bad);
  EXPECT_NEAR(peak(*bad, "jerk", "X").share, 1.002, 1e-6);
  EXPECT_GT(peak(*bad, "jerk", "X").rows_over, 10u);
}

TEST(Logbook, MeasuresTheFeed) {
  const auto slow = check_text(move_of(20000, 0.04, 20).text());  // peaks at 32 mm/s
  ASSERT_TRUE(slow);
  EXPECT_NEAR(peak(*slow, "feed", "").share, 1.6, 0.01);
  EXPECT_GT(peak(*slow, "feed", "").rows_over, 0u);
}

TEST(Logbook, SeesRowsThatAreMissing) {
  Written log = move_of(20000, 0.04);
  std::string text = log.text();
  text.erase(text.rfind('\n', text.size() - 2) + 1);  // the last row
  const auto check = check_text(text);
  ASSERT_TRUE(check);
  ASSERT_FALSE(check->problems.empty());
  EXPECT_NE(check->problems[0].find("not complete"), std::string::npos);
}

TEST(Logbook, ComparesTheTipWithTheProgrammedPath) {
  const Written log = move_of(20000, 0.04);
  const double end = 2 * 20000 * 0.04 * 0.04 * 0.04;
  IdealPiece line;
  line.block = line.line = 1;
  line.end = {end, 0, 0};
  const auto good = check_text(log.text(), pieces({line}));
  ASSERT_TRUE(good);
  EXPECT_TRUE(good->problems.empty());
  EXPECT_LT(good->deviation, 1e-9);
  line.end = {end, 0.01, 0};
  const auto off = check_text(log.text(), pieces({line}));
  ASSERT_TRUE(off);
  EXPECT_FALSE(off->problems.empty());
  EXPECT_NEAR(off->deviation, 0.01, 1e-4);
  line.tolerance = 0.011;
  const auto allowed = check_text(log.text(), pieces({line}));
  ASSERT_TRUE(allowed);
  EXPECT_TRUE(allowed->problems.empty());
}

TEST(Logbook, SeesAPieceThatIsNeverGoneAlong) {
  const Written log = move_of(20000, 0.04);
  const double end = 2 * 20000 * 0.04 * 0.04 * 0.04;
  IdealPiece line, more;
  line.block = line.line = 1;
  line.end = more.start = {end, 0, 0};
  more.block = more.line = 2;
  more.end = {end, 50, 0};
  const auto check = check_text(log.text(), pieces({line, more}));
  ASSERT_TRUE(check);
  ASSERT_EQ(check->problems.size(), 1u);
  EXPECT_NE(check->problems[0].find("line 2"), std::string::npos) << check->problems[0];
}

TEST(Logbook, MeasuresTheDistanceFromAHelix) {
  // Two turns about Z of radius 10, 3 mm up, sampled exactly and once 0.02 mm outside.
  IdealPiece helix;
  helix.block = helix.line = 1;
  helix.arc = true;
  helix.start = {10, 0, 0};
  helix.end = {10, 0, 3};
  helix.normal = {0, 0, 1};
  helix.turns = 2;
  for (const double outside : {0.0, 0.02}) {
    Written log;
    std::string rows;
    for (int k = 0; k <= 4000; ++k) {
      const double f = k / 4000.0, phi = 4 * M_PI * f, r = 10 + (k == 1234 ? outside : 0);
      log.add(r * std::cos(phi), r * std::sin(phi));
      std::string& text = log.rows;
      // z is the third of the pose, behind x and y.
      const std::size_t tail = text.rfind(",0,0,0,0,0,0,0,1,0,0,0,4\n");
      text.replace(tail, 2, "," + shortest(3 * f));
    }
    const auto check = check_text(log.text(), pieces({helix}));
    ASSERT_TRUE(check) << check.error().message;
    EXPECT_NEAR(check->deviation, outside, 1e-7);
    EXPECT_EQ(check->problems.empty(), outside == 0);
  }
}

TEST(Logbook, SaysWhereABadLogIsWrong) {
  const std::string good = move_of(20000, 0.04).text();
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = good;
    text.replace(text.find(from), from.size(), to);
    const SourceText source("joints.csv", text);
    const auto result = check(source, {});
    return result ? std::string("no error")
                  : result.error().span.place() + " " + result.error().message;
  };
  const auto says = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  const std::string number = with("\n0.001,1,1,2,100", "\n0.001,1,1,2,1x0");
  EXPECT_TRUE(says(number, "joints.csv:14:13")) << number;
  EXPECT_TRUE(says(number, "feed_cmd")) << number;
  const std::string format = with("joints-1", "joints-9");
  EXPECT_TRUE(says(format, "joints.csv:1:1")) << format;
  const std::string limits = with("limits_v=100,100", "limits_v=100");
  EXPECT_TRUE(says(limits, "joints.csv:7:3")) << limits;
  EXPECT_TRUE(says(limits, "1 values for 2 joints")) << limits;
  const std::string column = with("feed_act", "feed_axt");
  EXPECT_TRUE(says(column, "must be 'feed_act'")) << column;
  EXPECT_TRUE(says(with("# samples=", "# simples="), "'samples'"));
  EXPECT_TRUE(says(with(",4\n0.001,", "\n0.001,"), "cut off"));
}

TEST(Logbook, TellsWhatDiffersBetweenTwoLogs) {
  const Written one = move_of(20000, 0.04);
  Written two = one;
  const SourceText a("a.csv", one.text()), b("b.csv", two.text());
  const auto same = compare(a, b, 1e-6);
  ASSERT_TRUE(same);
  EXPECT_FALSE(same->first);
  const SourceText c("c.csv", move_of(19000, 0.04).text());
  const auto other = compare(a, c, 1e-6);
  ASSERT_TRUE(other);
  ASSERT_TRUE(other->first);
  EXPECT_LT(*other->first, 0.01);
  EXPECT_NEAR(other->differences[0].most, 2 * 1000 * 0.04 * 0.04 * 0.04, 1e-9);
}

TEST(Logbook, ExportsTheColumnsAskedFor) {
  const SourceText log("joints.csv", move_of(20000, 0.002).text());
  const auto exported = [&](Table table, std::vector<std::string> columns, std::uint64_t every) {
    std::string out;
    const auto done = export_table(log, {table, std::move(columns), every},
                                   [&](std::string_view text) { out += text; });
    return done ? out : done.error().message;
  };
  EXPECT_EQ(exported(Table::csv, {"t", "motion"}, 4), "t,motion\n0,2\n0.004,2\n0.008,2\n");
  const std::string json = exported(Table::json, {"t", "line"}, 8);
  EXPECT_NE(json.find("\"columns\":{\"t\":[0,0.008],\"line\":[1,1]}"), std::string::npos) << json;
  const std::string npy = exported(Table::npy, {"t", "q0"}, 1);
  EXPECT_EQ(npy.substr(0, 6), "\x93NUMPY");
  EXPECT_EQ((npy.size() - 9 * 2 * sizeof(double)) % 64, 0u);
  EXPECT_NE(npy.find("'shape': (9,)"), std::string::npos);
  EXPECT_NE(exported(Table::csv, {"q7"}, 1).find("no column 'q7'"), std::string::npos);
}

TEST(Logbook, DrawsThePictureOfALog) {
  const SourceText log("joints.csv", move_of(20000, 0.04).text());
  const auto one = plot(log, {}), two = plot(log, {});
  ASSERT_TRUE(one) << one.error().message;
  EXPECT_EQ(one->substr(1, 3), "PNG");
  EXPECT_GT(one->size(), 10000u);
  EXPECT_EQ(*one, *two) << "the same log gives the same bytes";
  EXPECT_FALSE(plot(log, {.from = 5}));
  EXPECT_FALSE(plot(log, {.width = 10}));
}

}  // namespace
}  // namespace aircut::logbook
