// The O-words of one file and how they belong together, found once by reading the file's O-lines
// from top to bottom. Nothing else of the file is looked at, and calls, of which a program may have
// millions, are not kept: nothing leads to them.
#pragma once

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "base/source.h"
#include "interp/block.h"

namespace aircut::interp {

struct FlowEntry {
  std::uint64_t begin = 0;  ///< byte offset of the line
  std::uint64_t after = 0;  ///< byte offset of the line behind it
  std::uint64_t line = 0;
  Keyword keyword = Keyword::none;
  std::string label;
  Place place;                ///< of the O-word in its line
  int sub = -1;               ///< entry of the sub that it is in, -1 outside
  int next = -1;              ///< if, elseif, else: the next branch or the endif
  int partner = -1;           ///< opener: its end. End, break, continue: the opener
  bool called_ahead = false;  ///< a sub that was called before its definition was passed
  bool passed = false;        ///< a sub whose definition was passed
  Block* block = nullptr;     ///< its parsed line when that is kept
  const char* problem_kind = nullptr;
  std::string problem;  ///< what is wrong with it when it is reached
};

/// A block with an N word (macro B).
struct NumberedBlock {
  std::int32_t number = 0;
  int program = -1;  ///< entry of the program that it is in, -1 without header
  int loop = -1;     ///< entry of the innermost DO around it
  BlockPlace place;
};

class Parameters;
class CodeTable;

class FlowIndex {
 public:
  FlowIndex(const SourceText& source, std::uint64_t begin, bool block_delete, bool stops_at_percent,
            Parameters& parameters, const CodeTable& table);

  std::deque<FlowEntry> entries;  ///< in the order of the file; growing needs no second copy

  /// True when the file has more of them than are kept; the rest was not read.
  bool overfull() const { return overfull_; }
  static constexpr std::size_t max_entries = 2'000'000;   ///< O-words, headers, loops
  static constexpr std::size_t max_numbered = 8'000'000;  ///< N blocks

  /// The entry of the line that begins there, or -1.
  int at(std::uint64_t begin) const;
  /// `oLABEL sub`, or -1.
  int find_sub(std::string_view label) const;
  /// A sub whose label is an expression has this number from now on.
  void name_sub(int at, std::string label) { subs_[std::move(label)] = at; }
  /// Fanuc-style `OLABEL` behind `after`, else anywhere, or -1.
  int find_fanuc(std::string_view label, std::uint64_t after) const;

  // ---- macro B: programs, DO and END are entries; a DO has the DO around it as `next`
  /// The header `O` number, or -1.
  int find_program(std::int64_t number) const { return find_sub(std::to_string(number)); }
  /// The header above the line that begins there, or -1.
  int program_at(std::uint64_t begin) const;
  /// N `number` of the program in which the line at `from` stands: the first one behind that line,
  /// else the first one from the top, as the control looks for it.
  const NumberedBlock* find_block(std::int64_t number, std::uint64_t from) const;

 private:
  void read_macro_b(const SourceText& source, std::uint64_t begin, bool block_delete,
                    bool stops_at_percent, Parameters& parameters, const CodeTable& table);
  void connect_macro_b(int at);
  void close_loop(int at);
  void connect();
  void open(int at);
  void close(int at);
  void branch(int at);
  void leave_loop(int at);
  void problem(int at, const char* kind, std::string text);
  void leave_open(int at, const std::string& text);
  void end_scope();

  std::vector<int> open_;            ///< entries of the constructs that are open, innermost last
  std::set<std::string_view> used_;  ///< labels of the scope, kept by the entries
  std::map<std::string, int, std::less<>> subs_;
  int sub_ = -1;
  bool overfull_ = false;
  std::deque<NumberedBlock> numbered_;  ///< by program, number, place
};

}  // namespace aircut::interp
