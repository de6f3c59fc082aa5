// The recursive descent over one line, shared by the files that hold its parts: parser.cpp (words,
// comments, settings), expression_parser.cpp (values) and oword_parser.cpp (flow of control).
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/text.h"
#include "interp/block.h"
#include "interp/code_table.h"
#include "interp/lexer.h"
#include "interp/parameters.h"

namespace aircut::interp {

struct Operator;

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

  bool item();
  bool comment();
  bool semicolon();
  bool line_number();
  bool word(char letter);
  bool add_word(Word& word);
  bool setting();
  bool oword();
  bool oword_arguments();
  bool label();
  bool only_comments_left();

  bool value(Value& out);
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
    out_.code.push_back({op, id, number, place});
  }

  Cursor in_;
  Parameters& parameters_;
  const CodeTable& table_;
  Block& out_;
  std::optional<Fault> fault_;
  int depth_ = 0;
  int m_words_ = 0;
  int g_groups_ = 0;
};

}  // namespace aircut::interp
