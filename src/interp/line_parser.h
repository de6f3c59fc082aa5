// The recursive descent over one line, shared by the files that hold its parts: parser.cpp (words,
// comments, settings), expression_parser.cpp (values) and oword_parser.cpp (flow of control);
// macro_parser.cpp and macro_expression_parser.cpp have what Fanuc-like dialects do otherwise.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "base/text.h"
#include "interp/block.h"
#include "interp/code_table.h"
#include "interp/lexer.h"
#include "interp/parameters.h"

namespace aircut::interp {

struct Operator {
  const char* name;
  Op op;
  int level;  ///< higher binds closer
};

inline bool is_letter(char c) { return c >= 'a' && c <= 'z'; }
inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
inline std::string quoted(char c) { return "'" + printable(std::string_view(&c, 1)) + "'"; }

class LineParser {
 public:
  LineParser(std::string_view line, Parameters& parameters, const CodeTable& table, Block& out)
      : in_(line), parameters_(parameters), table_(table), out_(out) {}

  std::optional<Fault> parse();

 private:
  bool fail(const char* kind, std::uint32_t begin, std::uint32_t length, std::string message) {
    if (!fault_) fault_ = Fault{kind, {begin, length}, std::move(message)};
    return false;
  }
  bool fail_here(const char* kind, std::string message) {
    return fail(kind, in_.position(), in_.at_end() ? 0 : 1, std::move(message));
  }
  bool fail_from(const char* kind, std::uint32_t begin, std::string message) {
    return fail(kind, begin, in_.length_since(begin), std::move(message));
  }

  void plain_words();
  bool item();
  bool comment();
  bool semicolon();
  bool line_number();
  bool word(char letter);
  bool word_behind(std::uint32_t begin, char letter);
  bool misplaced_word(char letter);
  bool read_word(Word& word);
  bool add_word(Word& word);
  bool too_many_codes(const Word& word);
  bool second_word(const Word& word);
  bool setting();
  bool oword();
  bool oword_arguments();
  bool label();
  bool only_comments_left();

  // ---- macro B (macro_parser.cpp)
  std::optional<Fault> parse_macro_b();
  bool macro_item();
  std::optional<bool> macro_statement();
  bool program_header();
  bool block_number();
  bool end_of_block();
  bool comma_word();
  bool conditional_return();
  bool returns_only() const;
  bool macro_if(std::uint32_t begin);
  bool macro_goto(std::uint32_t begin, Keyword keyword);
  bool macro_while(std::uint32_t begin);
  bool loop_number(std::uint32_t begin, Keyword keyword);
  bool output_statement(std::uint32_t begin);
  bool condition();
  bool read_macro_word(Word& word);
  bool add_macro_word(Word& word);
  bool macro_setting(Setting& setting);

  // ---- values of macro B (macro_expression_parser.cpp)
  std::span<const Operator> macro_operators() const;
  bool macro_function(std::uint32_t begin);
  bool macro_arguments(int& count);
  bool macro_parameter();
  bool whole_expression(Value& out);
  /// A vacant variable on top of the stack counts as 0 from here on.
  void make_solid();
  void make_solid_value(Value& value);
  void note_logic(const Operator& op, Place place);

  bool value(Value& out);
  bool number_may_end(std::uint32_t begin, double number);
  bool compiled_value(Value& out);
  bool operand();
  bool expression_in_brackets();
  bool climb(int level);
  bool function(std::uint32_t begin);
  bool exists(std::uint32_t begin);
  bool parameter(bool only_exists);
  std::optional<std::string> name_in_angles();
  const Operator* peek_operator();
  std::uint32_t operator_length(const Operator& op) const;
  void emit(Op op, Place place, double number = 0, std::int32_t id = 0) {
    out_.code.push_back({op, Right::stack, id, number, place});
  }
  void emit_unary(Op op, Place place);
  void emit_binary(Op op, Place place, std::size_t left, std::size_t right);

  Cursor in_;
  Parameters& parameters_;
  const CodeTable& table_;
  Block& out_;
  std::optional<Fault> fault_;
  int depth_ = 0;
  int m_words_ = 0;
  int g_groups_ = 0;
  int brackets_ = 0;          ///< open ones, for the control's own limit
  bool relation_ = false;     ///< the innermost bracket has EQ, NE …
  bool logic_ = false;        ///< and AND, OR, XOR
  char address_ = 0;          ///< of the word whose value is being read
  bool macro_words_ = false;  ///< what follows are arguments of G65 or G66
};

}  // namespace aircut::interp
