// The O-words of one file and how they belong together, found once by reading the file's O-lines
// from top to bottom. Nothing else of the file is looked at, and calls, of which a program may have
// millions, are not kept: nothing leads to them.
//
// An entry takes 32 bytes and no texts: its label and its place in the line are read again from the
// program when they are needed. What does not fit into a few MiB goes to a temporary file
// (base/spilled.h), so the memory does not grow with the number of entries.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/source.h"
#include "base/spilled.h"
#include "interp/block.h"

namespace aircut::interp {

/// What may be wrong with the structure at an O-word.
enum class FlowFault : unsigned char { none, missing, reused, nesting, syntax, limit };

struct FlowEntry {
  std::uint64_t begin = 0;  ///< byte offset of the line
  std::uint64_t line = 0;
  std::int32_t sub = -1;      ///< entry of the sub that it is in, -1 outside
  std::int32_t next = -1;     ///< if, elseif, else: the next branch or the endif
  std::int32_t partner = -1;  ///< opener: its end. End, break, continue: the opener
  Keyword keyword = Keyword::none;
  FlowFault fault = FlowFault::none;  ///< told when the program gets there
  bool called_ahead = false;          ///< a sub that was called before its definition was passed
  bool passed = false;                ///< a sub whose definition was passed, or that was called
};

/// What the line of an entry says.
struct FlowLine {
  std::string label;
  Place place;              ///< of the O-word in its line
  std::uint64_t after = 0;  ///< byte offset of the line behind it
};

struct FlowProblem {
  const char* kind = "";
  std::string text;
};

/// A block with an N word (macro B).
struct NumberedBlock {
  std::int32_t number = 0;
  int loop = -1;  ///< entry of the innermost DO around it
  BlockPlace place;
};

class Parameters;
class CodeTable;

class FlowIndex {
 public:
  /// Text, parameters and table must outlive the index.
  FlowIndex(const SourceText& source, std::uint64_t begin, bool block_delete, bool stops_at_percent,
            Parameters& parameters, const CodeTable& table);

  SpilledArray<FlowEntry> entries;  ///< in the order of the file

  /// True when there was no room for all of them; the rest was not read.
  bool overfull() const { return overfull_; }

  FlowLine line_of(int at);
  /// Where the line behind it begins.
  std::uint64_t after(int at);
  /// What is wrong with an entry that has a fault.
  FlowProblem problem_of(int at);

  /// The entry of the line that begins there, or -1.
  int at(std::uint64_t begin);
  /// `oLABEL sub`, or -1.
  int find_sub(std::string_view label);
  /// A sub whose label is an expression has this number from now on. False when there are too many.
  bool name_sub(int at, const std::string& label);
  /// The first Fanuc-style `OLABEL` that stands there or further down, or -1.
  int find_fanuc(std::string_view label, std::uint64_t from);
  /// The Fanuc-style `OLABEL` that was called before, or -1.
  int find_called_fanuc(std::string_view label);

  // ---- macro B: programs, DO and END are entries; a DO has the DO around it as `next`
  /// The header `O` number, or -1.
  int find_program(std::int64_t number) { return find_sub(std::to_string(number)); }
  /// The header above the line that begins there, or -1.
  int program_at(std::uint64_t begin);
  /// N `number` of the program in which the line at `from` stands: the first one behind that line,
  /// else the first one from the top, as the control looks for it.
  std::optional<NumberedBlock> find_block(std::int64_t number, std::uint64_t from);

  static constexpr std::size_t max_open = 1000;         ///< loops and branches inside each other
  static constexpr std::size_t max_computed = 100'000;  ///< labels given by name_sub

 private:
  struct Open {  ///< a construct that has no end yet
    int at = -1;
    Keyword keyword = Keyword::none;
    std::string label;
  };
  struct LabelUse {  ///< of a loop or branch
    std::uint64_t hash = 0;
    std::int32_t scope = 0;
    std::int32_t entry = 0;
  };
  struct SubName {
    std::uint64_t hash = 0;
    std::int32_t fanuc = 0;
    std::int32_t entry = 0;
  };
  struct Numbered {
    std::uint64_t begin = 0;
    std::uint64_t line = 0;
    std::int32_t number = 0;
    std::int32_t program = -1;
    std::int32_t loop = -1;
  };
  struct Jump {  ///< a search that was done
    std::int64_t number = -1;
    std::uint64_t from = 0;
    std::optional<NumberedBlock> found;
  };

  void read_o_words(std::uint64_t begin, bool block_delete, bool stops_at_percent);
  void read_macro_b(std::uint64_t begin, bool block_delete, bool stops_at_percent);
  bool add(const FlowEntry& entry);
  void connect_macro_b(int at, const std::string& label);
  void close_loop(int at, const std::string& label);
  void connect(int at, const std::string& label);
  void open(int at, const std::string& label);
  void close(int at, const std::string& label);
  void branch(int at, const std::string& label);
  void leave_loop(int at, const std::string& label);
  void problem(int at, FlowFault fault, std::string text);
  void leave_open(int at, const std::string& text);
  void end_scope();
  void find_reused_labels();
  void name(int at, const std::string& label, bool fanuc);
  bool has_label(int at, std::string_view label) { return line_of(at).label == label; }
  template <class Fits>
  int first_fanuc(std::string_view label, std::int32_t from, const Fits& fits);
  std::optional<NumberedBlock> search(std::int64_t number, std::uint64_t from);

  const SourceText& source_;
  Parameters& parameters_;
  const CodeTable& table_;
  std::vector<Open> open_;  ///< innermost last
  SpilledArray<LabelUse> labels_;
  int scope_ = 0;  ///< a number for each stretch in which labels count
  std::map<std::string, int, std::less<>>
      subs_;  ///< the first ones, and those with computed labels
  std::size_t computed_ = 0;
  SpilledArray<SubName> names_;  ///< of the other subs, and all of Fanuc's style
  std::map<int, std::string> problems_;
  int sub_ = -1;
  std::string sub_label_;
  bool overfull_ = false;
  int last_ = -1;                    ///< entry that was looked for last
  SpilledArray<Numbered> numbered_;  ///< by program, number, place
  std::array<Jump, 64> jumps_;
};

}  // namespace aircut::interp
