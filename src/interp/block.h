// One line of a program as a value: words, settings, comments, or one O-word construct, each with
// its place. A block holds no state; the numbers of its words are filled in when it is executed.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interp/expression.h"

namespace aircut::interp {

struct CodeRule;

/// A word such as `X10`, `G5.1` or `P[#1+2]`.
struct Word {
  char letter = 0;  ///< upper case, one of $ @ ^, or a c r for ,A ,C ,R
  Place place;
  Value text;                      ///< as written
  double number = 0;               ///< as evaluated when the block is executed
  const CodeRule* rule = nullptr;  ///< of a G or M word whose number is constant
  bool no_point = false;           ///< a whole number without a decimal point
};

/// `#3=…` or `#<name>=…`.
struct Setting {
  Place place;             ///< of the target
  std::int32_t name = -1;  ///< id of a named parameter, else -1
  std::int32_t plain = 0;  ///< number of a parameter that can be set at any time, else 0
  Value target;            ///< number of a numbered parameter
  Value value;
};

struct Comment {
  Place place;
  std::uint32_t text_begin = 0;  ///< what stands between the parentheses, relative to the line
  std::uint32_t text_length = 0;
};

enum class Keyword : unsigned char {
  none,
  sub,
  endsub,
  call,
  return_,
  if_,
  elseif,
  else_,
  endif,
  while_,
  endwhile,
  do_,
  repeat,
  endrepeat,
  break_,
  continue_,
  fanuc_sub,
  // macro B
  program,   ///< O1234
  goto_,     ///< GOTO n
  if_goto,   ///< IF [c] GOTO n
  if_then,   ///< IF [c] THEN #1=…
  if_m99,    ///< [c] M99 P… (Haas)
  while_do,  ///< WHILE [c] DO1, or DO1 alone
  end_,      ///< END1
  output,    ///< DPRNT[…]
  nothing    ///< SETVN, POPEN, PCLOS: accepted, without an effect here
};

/// `o100 while [#1 lt 5]`, or a statement of macro B.
struct OWord {
  Keyword keyword = Keyword::none;
  Place place;                    ///< `o` up to the keyword; macro B: what a message underlines
  std::string label;              ///< normalised: lower case without blanks, `100`, `name`, `[#1]`
  std::optional<Value> computed;  ///< label given as an expression
  std::vector<Value> arguments;
  std::vector<Place> argument_places;
  std::int32_t entry = -1;             ///< index in the file's flow index once known
  std::int32_t jump_entry = -1;        ///< where it has led last: an entry of the index
  struct Block* jump_block = nullptr;  ///< the kept line of that entry
};

/// A line of a program by its place.
struct BlockPlace {
  std::uint64_t begin = 0;  ///< byte offset of the line
  std::uint64_t after = 0;  ///< of the line behind it
  std::uint64_t line = 0;   ///< from 1
};

struct Block {
  std::uint64_t begin = 0;       ///< byte offset of the line in its text
  std::uint64_t line = 0;        ///< from 1
  std::uint32_t length = 0;      ///< bytes without line end and trailing blanks
  std::uint64_t next_begin = 0;  ///< where the following line starts
  bool block_delete = false;
  bool empty = true;           ///< nothing but blanks
  bool has_rules = false;      ///< has G or M words
  bool plain_settings = true;  ///< macro B: of no system variable
  bool plain_move = true;      ///< nothing but words of a move (move_letters) and perhaps G0-G3
  const CodeRule* plain_rule = nullptr;  ///< of that G0-G3
  std::uint32_t letters = 0;             ///< bit per letter_index of a word
  bool has_expressions = false;          ///< some word needs evaluation
  std::vector<Word> words;
  std::array<std::int8_t, 32> slot{};  ///< letter_index → position in words, -1 without
  std::vector<Setting> settings;
  std::int64_t number = -1;        ///< macro B: of the N word
  std::vector<Word> macro_words;   ///< macro B: behind G65 or G66, in the order of the line
  std::vector<Fault> warnings;     ///< told when the block is executed
  std::optional<Comment> comment;  ///< the last parenthesised one
  OWord oword;
  Code code;                   ///< instructions of all expressions of the line
  Block* following = nullptr;  ///< the next line when that is cached too

  const Word* find(char letter) const;
  void clear();
};

/// 0..25 for A..Z, then $ @ ^, then the words with a comma: ,A ,C ,R are the letters a c r.
constexpr int letter_index(char letter) {
  if (letter >= 'A' && letter <= 'Z') return letter - 'A';
  switch (letter) {
    case '$':
      return 26;
    case '@':
      return 27;
    case 'a':
      return 29;
    case 'c':
      return 30;
    case 'r':
      return 31;
    default:
      return 28;  // ^
  }
}
/// As a program writes it: `X`, `,R`.
inline std::string written(char letter) {
  if (letter >= 'a' && letter <= 'z') return {',', static_cast<char>(letter - 32)};
  return std::string(1, letter);
}

constexpr std::uint32_t letter_bit(char letter) { return 1u << letter_index(letter); }
constexpr std::uint32_t axis_letters = letter_bit('X') | letter_bit('Y') | letter_bit('Z') |
                                       letter_bit('A') | letter_bit('B') | letter_bit('C') |
                                       letter_bit('U') | letter_bit('V') | letter_bit('W');

constexpr std::uint32_t centre_letters = letter_bit('I') | letter_bit('J') | letter_bit('K');
/// What a line of a program mostly has.
constexpr std::uint32_t move_letters =
    axis_letters | centre_letters | letter_bit('R') | letter_bit('F');

inline const Word* Block::find(char letter) const {
  const int at = slot[static_cast<std::size_t>(letter_index(letter))];
  return at < 0 ? nullptr : &words[static_cast<std::size_t>(at)];
}

}  // namespace aircut::interp
