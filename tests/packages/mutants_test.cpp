// Seeded faults: a clean job is spoiled in one place at a time, in the ways that people spoil them,
// and every fault must be found at its line. The clean job gives no error and no warning.
//
// The job is programs/bracket.ngc with its block; AIRCUT_MUTANTS=all tries every fault, otherwise
// a few that are quick. Each is a run of its own, and as many run at once as there are cores.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

namespace aircut {
namespace {

namespace fs = std::filesystem;

std::string read(const fs::path& path) {
  std::ifstream in(path);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at != std::string::npos) text.replace(at, from.size(), to);
  return text;
}

// What is run: texts that a fault changes.
struct Job {
  std::string program, setup, tools;
};

// A fault and where it must show.
struct Mutant {
  std::string kind;  ///< of fault, for people
  Job job;
  std::string file;               ///< end of the name that the message begins with
  std::size_t low = 0, high = 0;  ///< its lines
  std::vector<std::string> kinds;
  bool quick = true;  ///< few contacts: their depths take time
};

class SeededFaults : public ::testing::Test {
 protected:
  SeededFaults() {
    const fs::path source(AIRCUT_SOURCE_DIR);
    // Places on rays are exact at any pitch, so a coarse lattice is enough.
    clean_ = {read(source / "programs/bracket.ngc"),
              replaced(read(source / "programs/mill3-block.setup.toml"), "[stock]\n",
                       "[stock]\npitch = 0.5\n"),
              read(source / "machines/mill3/tools.toml")};
    program_ = lines_of(clean_.program);
    std::string name = (fs::temp_directory_path() / "aircut-mutants-XXXXXX").string();
    folder_ = ::mkdtemp(name.data());
    fs::create_directory(folder_ / "holders");
    for (const auto& entry : fs::directory_iterator(source / "machines/mill3/holders"))
      fs::copy(entry.path(), folder_ / "holders");
  }
  ~SeededFaults() override { fs::remove_all(folder_); }

  // The messages of a run in a folder of its own, one per line.
  std::vector<std::string> messages(const Job& job, std::size_t number) const {
    const fs::path place = folder_ / std::to_string(number);
    fs::create_directory(place);
    fs::create_directory_symlink(folder_ / "holders", place / "holders");
    std::ofstream(place / "job.ngc") << job.program;
    std::ofstream(place / "job.setup.toml") << job.setup;
    std::ofstream(place / "tools.toml") << job.tools;
    const std::string command =
        "cd " + place.string() + " && timeout 120 " + fs::absolute(AIRCUT_BINARY_DIR).string() +
        "/bin/aircut run job.ngc -m " + fs::absolute(AIRCUT_SOURCE_DIR).string() +
        "/machines/mill3 --setup job.setup.toml -t tools.toml --format gcc"
        " 2>&1";
    std::string out;
    if (std::FILE* pipe = ::popen(command.c_str(), "r")) {
      std::array<char, 4096> buffer;
      for (std::size_t n; (n = std::fread(buffer.data(), 1, buffer.size(), pipe)) > 0;)
        out.append(buffer.data(), n);
      ::pclose(pipe);
    }
    fs::remove_all(place);
    return lines_of(out);
  }

  // The messages of all runs, in their order.
  std::vector<std::vector<std::string>> all_messages(const std::vector<Mutant>& mutants) const {
    std::vector<std::vector<std::string>> out(mutants.size());
    std::atomic<std::size_t> next{0};
    std::vector<std::thread> workers(std::max(std::thread::hardware_concurrency(), 1u));
    for (std::thread& worker : workers)
      worker = std::thread([&] {
        for (std::size_t i = next++; i < mutants.size(); i = next++)
          out[i] = messages(mutants[i].job, i);
      });
    for (std::thread& worker : workers) worker.join();
    return out;
  }

  static bool found(const Mutant& mutant, const std::vector<std::string>& messages) {
    for (const std::string& message : messages) {
      if (message.find(": error: ") == std::string::npos &&
          message.find(": warning: ") == std::string::npos)
        continue;
      const std::string start = mutant.file + ":";
      if (!message.starts_with(start)) continue;
      const std::size_t line = std::strtoul(message.c_str() + start.size(), nullptr, 10);
      if (line < mutant.low || line > mutant.high) continue;
      for (const std::string& kind : mutant.kinds)
        if (message.ends_with("[" + kind + "]")) return true;
    }
    return false;
  }

  // The program with one line changed; lines count from 1.
  Job with_line(std::size_t line, const std::string& text) const {
    Job job = clean_;
    job.program.clear();
    for (std::size_t i = 0; i < program_.size(); ++i)
      job.program += (i + 1 == line ? text : program_[i]) + "\n";
    return job;
  }

  // Lines that begin with this, from the header on.
  std::vector<std::size_t> lines_with(const std::string& start) const {
    std::vector<std::size_t> out;
    for (std::size_t i = 8; i < program_.size(); ++i)
      if (program_[i].starts_with(start)) out.push_back(i + 1);
    EXPECT_FALSE(out.empty()) << start;
    return out;
  }
  std::size_t next(std::size_t line, const std::string& text) const {
    for (std::size_t i = line; i < program_.size(); ++i)
      if (program_[i].find(text) != std::string::npos) return i + 1;
    return program_.size();
  }

  void feed_becomes_rapid(std::vector<Mutant>& out) const;
  void spindle(std::vector<Mutant>& out) const;
  void lengths(std::vector<Mutant>& out) const;
  void changes(std::vector<Mutant>& out) const;
  void clearances(std::vector<Mutant>& out) const;
  void set_up(std::vector<Mutant>& out) const;
  void rapids(std::vector<Mutant>& out) const;
  void planes(std::vector<Mutant>& out) const;
  void retracts(std::vector<Mutant>& out) const;
  void stick_outs(std::vector<Mutant>& out) const;

  Job clean_;
  std::vector<std::string> program_;
  fs::path folder_;
};

// G0 in place of G1 on lines that take material.
void SeededFaults::feed_becomes_rapid(std::vector<Mutant>& out) const {
  for (const char* text :
       {"G1 X62 F1100", "  G1 Y-29", "  G1 X-49", "  G1 Y29", "  G1 X15 Z", "    G1 X[10 +",
        "    G1 Y#<step>", "    G1 X[-10", "G1 Y14", "G1 X-24", "G1 Y-14", "G1 X24"}) {
    const std::size_t line = next(8, text);
    out.push_back({"feed becomes rapid",
                   with_line(line, replaced(program_[line - 1], "G1", "G0")),
                   "job.ngc",
                   line,
                   line,
                   {"rapid_cut"}});
  }
}

// No M3, M4 in place of M3, S0.
void SeededFaults::spindle(std::vector<Mutant>& out) const {
  for (const std::size_t line : lines_with("S")) {
    const std::size_t end = next(line, "M6");
    const auto add = [&](const char* what, const std::string& text, const char* kind) {
      out.push_back({what, with_line(line, text), "job.ngc", line, end, {kind}});
    };
    add("no M3", replaced(program_[line - 1], " M3", ""), "spindle_stopped_cut");
    add("M4", replaced(program_[line - 1], "M3", "M4"), "spindle_direction_cut");
    add("S0", "S0 M3", "spindle_stopped_cut");
  }
  for (const std::size_t line : lines_with("M8"))
    out.push_back({"M5 in place of M8",
                   with_line(line, "M5"),
                   "job.ngc",
                   line,
                   next(line, "M6"),
                   {"spindle_stopped_cut"}});
}

// Each H in place of each other one, and none.
void SeededFaults::lengths(std::vector<Mutant>& out) const {
  for (const std::size_t line : lines_with("G43 H")) {
    for (const char* h : {"1", "2", "4", "5", "6", "8"}) {
      const std::string text = std::string("G43 H") + h;
      if (program_[line - 1] != text)
        out.push_back({"wrong H", with_line(line, text), "job.ngc", line, line, {"wrong_offset"}});
    }
    // T8 is as long as T2 before it: nothing goes wrong there.
    if (program_[line - 1] == "G43 H8") continue;
    out.push_back(
        {"no G43",
         with_line(line, ""),
         "job.ngc",
         line,
         next(line, "M6"),
         {"length_offset_missing", "wrong_offset", "rapid_cut", "collision", "overtravel"}});
  }
}

// A tool change that is missing: the tool before it goes on.
void SeededFaults::changes(std::vector<Mutant>& out) const {
  for (const std::size_t line : lines_with("T"))
    out.push_back(
        {"no tool change",
         with_line(line, ""),
         "job.ngc",
         line,
         next(line + 1, "M6"),
         {"wrong_offset", "no_tool_cut", "length_offset_missing", "rapid_cut", "not_checked"}});
  for (const std::size_t line : lines_with("T"))
    for (const char* t : {"1", "2", "4", "5", "6", "8"}) {
      const std::string text = std::string("T") + t + " M6";
      if (program_[line - 1] != text)
        out.push_back({"wrong tool",
                       with_line(line, text),
                       "job.ngc",
                       line,
                       next(line, "M6"),
                       {"wrong_offset"}});
    }
}

// R planes and retracts below the face, a plane and a unit that are wrong, a hole through the vise.
void SeededFaults::clearances(std::vector<Mutant>& out) const {
  for (const char* cycle : {"G99 G81", "G98 G83"}) {
    const std::size_t line = next(8, cycle);
    // The drill's tip has room in the spot that was drilled before, down to Z-2.
    for (const char* r : {"R-3", "R-3.5", "R-4"})
      out.push_back({"R below the face",
                     with_line(line, replaced(program_[line - 1], "R2", r)),
                     "job.ngc",
                     line,
                     line,
                     {"rapid_cut"}});
  }
  const std::size_t above = next(54, "G0 Z2");
  for (const char* z : {"G0 Z-2", "G0 Z-3", "G0 Z-8"})
    out.push_back(
        {"approach below the face", with_line(above, z), "job.ngc", above, above, {"rapid_cut"}});
  const std::size_t finish = next(80, "G0 Z-8");
  for (const char* z : {"G0 Z-11", "G0 Z-12", "G0 Z-15"})
    out.push_back({"approach below the floor",
                   with_line(finish, z),
                   "job.ngc",
                   finish,
                   finish,
                   {"rapid_cut"}});
  const std::size_t drill = next(8, "G98 G83");
  for (const char* z : {"Z-90", "Z-100", "Z-110"})
    out.push_back({"drilled into the vise",
                   with_line(drill, replaced(program_[drill - 1], "Z-26", z)),
                   "job.ngc",
                   drill,
                   drill + 3,
                   {"collision", "overtravel"}});
  const std::size_t retract = next(47, "G0 Z20");
  out.push_back({"missing retract",
                 with_line(retract, "  G0 X60 Y-20"),
                 "job.ngc",
                 retract,
                 retract,
                 {"rapid_cut"}});
  const std::size_t pocket = next(75, "G0 Z20");
  for (const char* xy : {"G0 X40 Y0", "G0 X-40 Y10", "G0 X0 Y35", "G0 X10 Y-30"})
    out.push_back(
        {"missing retract", with_line(pocket, xy), "job.ngc", pocket, pocket, {"rapid_cut"}});
  const std::size_t head = next(0, "G17 G21");
  out.push_back({"wrong plane",
                 with_line(head, replaced(program_[head - 1], "G17", "G18")),
                 "job.ngc",
                 20,
                 20,
                 {"arc_error", "missing_word", "word_conflict", "unused_word"}});
  out.push_back({"wrong unit",
                 with_line(head, replaced(program_[head - 1], "G21", "G20")),
                 "job.ngc",
                 12,
                 20,
                 {"overtravel"}});
}

// Work offsets, a block that is too high, a clamp that stands elsewhere, tools that are longer than
// the table says.
void SeededFaults::set_up(std::vector<Mutant>& out) const {
  const auto setup = [&](const std::string& kind, const std::string& text, std::size_t low,
                         std::size_t high, std::vector<std::string> kinds) {
    Job job = clean_;
    job.setup += text;
    out.push_back({kind, job, "job.ngc", low, high, std::move(kinds)});
  };
  // Less than that goes as deep into the block without anything being wrong but the part.
  for (const int down : {6, 7, 8, 9, 10, 12, 15})
    setup("work offset too low",
          "[offsets]\nG54 = [0.0, 35.0, " + std::to_string(-424 - down) + ".0]\n", 10, 60,
          {"rapid_cut", "collision", "near_miss"});
  for (const char* offset :
       {"[0.0, 65.0, -424.0]", "[0.0, 5.0, -424.0]", "[0.0, 75.0, -424.0]", "[0.0, -5.0, -424.0]"})
    setup("work offset beside", "[offsets]\nG54 = " + std::string(offset) + "\n", 10, 130,
          {"rapid_cut", "collision"});
  for (const int up : {9, 12, 15, 18, 21}) {
    Job job = clean_;
    job.setup = replaced(job.setup, "fixture = \"vise\"\nplace = [0.0, -40.0, 76.0]",
                         "place = [0.0, 35.0, -474.0]");
    job.setup +=
        "[[fixture]]\nname = \"vise\"\nplace = [0.0, 75.0, " + std::to_string(-550 + up) + ".0]\n";
    out.push_back({"clamp too high", job, "job.ngc", 10, 60, {"collision", "near_miss"}});
  }
  for (const int higher : {10, 12, 16, 24}) {
    Job job = clean_;
    job.setup = replaced(job.setup, "79.8, 50.0]", "79.8, " + std::to_string(50 + higher) + ".0]");
    out.push_back({"block too high", job, "job.ngc", 10, 60, {"rapid_cut", "collision"}});
  }
  struct Length {
    const char* stick_out;
    double gauge;
  };
  for (const auto& [stick_out, gauge] :
       {Length{"36.0", 96}, Length{"30.0", 90}, Length{"74.0", 134},
        Length{"40.0\nholder = \"bt30-fma", 75}})
    for (const int longer : {1, 2, 5, 10}) {
      Job job = clean_;
      const std::string from = std::string("stick_out = ") + stick_out;
      const double length = std::strtod(stick_out, nullptr) + longer;
      std::string to = from;
      to.replace(12, 4, std::to_string(length));
      job.tools =
          replaced(job.tools, from, "offset = { z = " + std::to_string(gauge) + " }\n" + to);
      out.push_back(
          {"longer tool", job, "tools.toml", 1, 200, {"tools_invalid", "length_mismatch"}});
    }
}

void SeededFaults::rapids(std::vector<Mutant>& out) const {
  // Approaches that go below the face.
  struct Approach {
    const char* tool;
    const char* from;
    const char* to;
  };
  for (const auto& [tool, from, to] : {Approach{"T5 M6", "G0 Z5", "G0 X-50 Z-3"},
                                       {"T5 M6", "G0 Z5", "G0 X-30 Z-2"},
                                       {"T2 M6", "G0 Z20", "G0 X-40 Z-5"},
                                       {"T6 M6", "G0 Z2", "G0 X40 Y-20 Z-3"},
                                       {"T2 M6", "G0 Z20", "G0 Z-12"},
                                       {"T2 M6", "G0 Z20", "G0 X40 Z-6"},
                                       {"T8 M6", "G0 Z20", "G0 Z-3"},
                                       {"T8 M6", "G0 Z20", "G0 Z-5"},
                                       {"T4 M6", "G0 Z20", "G0 Z-8"},
                                       {"T4 M6", "G0 Z20", "G0 Z-20"},
                                       {"T6 M6", "G0 Z2", "G0 X-40 Y20 Z-4"}}) {
    const std::size_t line = next(next(8, tool), from);
    out.push_back(
        {"approach below the face", with_line(line, to), "job.ngc", line, line, {"rapid_cut"}});
  }
}

// Arcs and cycles in the wrong plane.
void SeededFaults::planes(std::vector<Mutant>& out) const {
  for (const char* plane : {"G18", "G19"}) {
    const std::size_t line = next(8, "G1 Z-1 F800"), arc = next(line, "G2");
    out.push_back({"wrong plane",
                   with_line(line, std::string(plane) + " " + program_[line - 1]),
                   "job.ngc",
                   arc,
                   arc,
                   {"arc_error"}});
  }
  for (const char* plane : {"G18", "G19"})
    for (const char* tool : {"T8 M6", "T4 M6"}) {
      const std::size_t line = next(next(8, tool), "M8");
      out.push_back({"wrong plane",
                     with_line(line, plane),
                     "job.ngc",
                     line,
                     line + 4,
                     {"cycle_error", "rapid_cut", "collision", "overtravel", "word_missing",
                      "axis_word_missing"}});
    }
}

// A sideways rapid where the tool should come up first.
void SeededFaults::retracts(std::vector<Mutant>& out) const {
  struct Place {
    const char* tool;
    std::vector<const char*> moves;
  };
  const Place places[] = {{"T5 M6", {"G0 X0 Y0 Z-3", "G0 X-20 Z-2", "G0 X0 Y10 Z-4"}},
                          {"T2 M6", {"G0 X40 Y0", "G0 X-40 Y0", "G0 X0 Y30", "G0 X10 Y-30"}},
                          {"T6 M6", {"G0 X40 Y20", "G0 X0 Y0", "G0 X-30 Y-20", "G0 X50 Y-30"}}};
  for (const Place& place : places) {
    const std::size_t first = next(8, place.tool);
    std::size_t line = first;  // the last retract with this tool
    for (std::size_t i = next(first, "G0 Z20"); i < next(first, "M6"); i = next(i, "G0 Z20"))
      line = i;
    for (const char* move : place.moves)
      out.push_back(
          {"missing retract", with_line(line, move), "job.ngc", line, line, {"rapid_cut"}});
  }
}

// A holder that is nearer to the tip than the cut is deep.
void SeededFaults::stick_outs(std::vector<Mutant>& out) const {
  struct Tool {
    const char* name;
    const char* as_it_is;
    std::vector<std::pair<const char*, const char*>> shorter;
  };
  const Tool tools[] = {
      {"T1 M6",
       "flute_length = 22.0\nstick_out = 36.0",
       {{"10.0", "11.0"}, {"11.0", "12.0"}, {"12.0", "13.0"}}},
      {"T2 M6", "flute_length = 16.0\nstick_out = 30.0", {{"6.0", "7.0"}, {"7.0", "8.0"}}},
      {"T4 M6", "flute_length = 61.0\nstick_out = 74.0", {{"15.0", "16.0"}, {"20.0", "22.0"}}}};
  for (const Tool& tool : tools) {
    const std::size_t line = next(8, tool.name);
    for (const auto& [flutes, stick_out] : tool.shorter) {
      Job job = clean_;
      job.tools = replaced(job.tools, tool.as_it_is,
                           std::string("flute_length = ") + flutes + "\nstick_out = " + stick_out);
      out.push_back({"short stick-out", job, "job.ngc", line, next(line, "M6"), {"collision"}});
    }
  }
}

TEST_F(SeededFaults, AreFoundAtTheirLines) {
  std::vector<Mutant> all;
  feed_becomes_rapid(all);
  spindle(all);
  const std::size_t quick = all.size();
  lengths(all);
  changes(all);
  clearances(all);
  set_up(all);
  rapids(all);
  planes(all);
  retracts(all);
  stick_outs(all);
  for (std::size_t i = quick; i < all.size(); ++i) all[i].quick = false;
  const bool every = std::getenv("AIRCUT_MUTANTS") != nullptr;
  std::vector<Mutant> tried;
  std::string last;
  for (const Mutant& mutant : all) {
    if (!every && (mutant.kind == last || !mutant.quick)) continue;
    last = mutant.kind;
    tried.push_back(mutant);
  }
  const std::size_t faults = tried.size();
  // And the job without a fault.
  tried.push_back({"clean", clean_, "job.ngc", 0, 0, {}});
  const auto said = all_messages(tried);
  for (std::size_t i = 0; i < tried.size(); ++i) {
    std::string text;
    for (std::size_t k = 0; k < said[i].size() && (k < 8 || i >= faults); ++k)
      text += said[i][k] + "\n";
    if (i < faults) {
      EXPECT_TRUE(found(tried[i], said[i])) << tried[i].kind << ", expected at " << tried[i].file
                                            << ":" << tried[i].low << "-" << tried[i].high << "\n"
                                            << text;
    } else {
      EXPECT_EQ(text.find(": error: "), std::string::npos) << text;
      EXPECT_EQ(text.find(": warning: "), std::string::npos) << text;
    }
  }
  if (every) {
    EXPECT_GE(all.size(), 200u);
  }
  RecordProperty("mutants", static_cast<int>(faults));
  std::printf("%zu mutants of %zu\n", faults, all.size());
}

}  // namespace
}  // namespace aircut
