// Recursive descent over the characters that count. Expressions are compiled by precedence
// climbing; all binary operators are left associative:
//   5  **    4  * / MOD    3  + -    2  EQ NE GT GE LT LE    1  AND OR XOR
// A unary minus belongs to the value behind it, so [-2**2] is 4.
#include "interp/parser.h"

#include <array>
#include <cmath>

#include "base/text.h"
#include "interp/code_table.h"
#include "interp/lexer.h"
#include "interp/parameters.h"

namespace aircut::interp {
namespace {

constexpr int max_bracket_depth = 64;
constexpr std::uint32_t max_line_length = 252;  // of the reference, without the line end

struct Function {
  const char* name;
  Op op;
};
constexpr std::array<Function, 14> functions = {{{"abs", Op::abs},
                                                 {"acos", Op::acos},
                                                 {"asin", Op::asin},
                                                 {"atan", Op::atan},
                                                 {"cos", Op::cos},
                                                 {"exp", Op::exp},
                                                 {"exists", Op::exists},
                                                 {"fix", Op::fix},
                                                 {"fup", Op::fup},
                                                 {"ln", Op::ln},
                                                 {"round", Op::round},
                                                 {"sin", Op::sin},
                                                 {"sqrt", Op::sqrt},
                                                 {"tan", Op::tan}}};

struct Operator {
  const char* name;
  Op op;
  int level;
};
constexpr std::array<Operator, 15> operators = {{{"**", Op::power, 5},
                                                 {"*", Op::multiply, 4},
                                                 {"/", Op::divide, 4},
                                                 {"mod", Op::modulo, 4},
                                                 {"+", Op::add, 3},
                                                 {"-", Op::subtract, 3},
                                                 {"eq", Op::equal, 2},
                                                 {"ne", Op::not_equal, 2},
                                                 {"gt", Op::greater, 2},
                                                 {"ge", Op::greater_equal, 2},
                                                 {"lt", Op::less, 2},
                                                 {"le", Op::less_equal, 2},
                                                 {"and", Op::and_, 1},
                                                 {"or", Op::or_, 1},
                                                 {"xor", Op::xor_, 1}}};

struct KeywordName {
  const char* name;
  Keyword keyword;
};
// Longer names stand before their beginnings.
constexpr std::array<KeywordName, 15> keywords = {{{"endsub", Keyword::endsub},
                                                   {"sub", Keyword::sub},
                                                   {"call", Keyword::call},
                                                   {"return", Keyword::return_},
                                                   {"elseif", Keyword::elseif},
                                                   {"else", Keyword::else_},
                                                   {"endif", Keyword::endif},
                                                   {"if", Keyword::if_},
                                                   {"endwhile", Keyword::endwhile},
                                                   {"while", Keyword::while_},
                                                   {"do", Keyword::do_},
                                                   {"endrepeat", Keyword::endrepeat},
                                                   {"repeat", Keyword::repeat},
                                                   {"break", Keyword::break_},
                                                   {"continue", Keyword::continue_}}};

bool is_letter(char c) { return c >= 'a' && c <= 'z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::string quoted(char c) { return "'" + printable(std::string_view(&c, 1)) + "'"; }

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

std::optional<Fault> LineParser::parse() {
  if (in_.at_end()) return std::nullopt;
  out_.empty = false;
  if (in_.line().size() > max_line_length) {
    fail("line_too_long", max_line_length,
         static_cast<std::uint32_t>(in_.line().size()) - max_line_length,
         "the line has " + std::to_string(in_.line().size()) +
             " characters; the control takes 252, split it");
    return fault_;
  }
  if (in_.accept('/')) out_.block_delete = true;
  if (in_.peek() == 'n' && !line_number()) return fault_;
  if (in_.peek() == 'o') {
    oword();
    return fault_;
  }
  while (!in_.at_end())
    if (!item()) break;
  return fault_;
}

bool LineParser::line_number() {
  const std::uint32_t begin = in_.position();
  in_.advance();
  double number = 0;
  if (!in_.read_digits(number))
    return fail_from("bad_number", begin, "N needs a line number, e.g. N100");
  return true;
}

bool LineParser::item() {
  const char c = in_.peek();
  if (c == '(') return comment();
  if (c == ';') return semicolon();
  if (c == '#') return setting();
  if (is_letter(c) || c == '$' || c == '@' || c == '^') return word(c);
  if (c == '/')
    return fail_here("bad_character", "'/' (block delete) may only be the first character");
  if (c == '%') return fail_here("bad_character", "'%' must stand alone on its line");
  if (is_digit(c) || c == '.' || c == '-' || c == '+')
    return fail_here("bad_character",
                     "a number without a letter; a word is a letter and a number, e.g. X10");
  if (c == ',')
    return fail_here("bad_character", "a comma can't be used; decimals are written with a point");
  return fail_here("bad_character", "the character " + quoted(c) + " can't be used here");
}

bool LineParser::comment() {
  const std::uint32_t begin = in_.position();
  const std::string_view line = in_.line();
  std::uint32_t at = begin + 1;
  while (at < line.size() && line[at] != ')') {
    if (line[at] == '(')
      return fail("bad_comment", at, 1, "a comment can't be nested; close the first one with ')'");
    ++at;
  }
  if (at >= line.size())
    return fail("bad_comment", begin, static_cast<std::uint32_t>(line.size()) - begin,
                "the comment is not closed; add ')' on the same line");
  out_.plain_move = false;
  out_.comment = Comment{{begin, at - begin + 1}, begin + 1, at - begin - 1};
  in_.go_to(at + 1);
  return true;
}

bool LineParser::semicolon() {
  in_.go_to(static_cast<std::uint32_t>(in_.line().size()));
  return true;
}

bool LineParser::word(char letter) {
  Word word;
  word.place.begin = in_.position();
  word.letter = is_letter(letter) ? static_cast<char>(letter - 32) : letter;
  if (letter == 'n') return fail_here("misplaced_word", "N must be the first word of the line");
  if (letter == 'o')
    return fail_here("misplaced_word", "an O-word must be the first word of the line (after N)");
  in_.advance();
  if (!value(word.text)) return false;
  word.place.length = in_.length_since(word.place.begin);
  return add_word(word);
}

bool LineParser::add_word(Word& word) {
  if (word.letter == 'G' || word.letter == 'M') {
    out_.has_rules = true;
    if (word.letter == 'M' && ++m_words_ > 4)
      return fail("too_many_m", word.place.begin, word.place.length,
                  "more than 4 M words on one line; put the others on a line of their own");
    if (word.letter == 'G' && ++g_groups_ > 20)
      return fail("modal_clash", word.place.begin, word.place.length,
                  "more G words on this line than there are modal groups");
    if (word.text.constant()) word.rule = table_.find(word.letter, word.text.number);
  } else {
    auto& slot = out_.slot[static_cast<std::size_t>(letter_index(word.letter))];
    if (slot >= 0)
      return fail("duplicate_word", word.place.begin, word.place.length,
                  std::string("a second ") + word.letter + " word on this line; one is allowed");
    slot = static_cast<std::int8_t>(out_.words.size());
  }
  const std::uint32_t bit = letter_bit(word.letter);
  const bool plain_g = word.rule && word.letter == 'G' && word.rule->code <= 10 && g_groups_ == 1;
  if (!(bit & axis_letters) && !plain_g) out_.plain_move = false;
  out_.letters |= bit;
  if (word.text.constant())
    word.number = word.text.number;
  else
    out_.has_expressions = true;
  out_.words.push_back(word);
  return true;
}

bool LineParser::setting() {
  Setting setting;
  setting.place.begin = in_.position();
  in_.advance();
  if (in_.peek() == '<') {
    const auto name = name_in_angles();
    if (!name) return false;
    setting.name = parameters_.intern(*name);
  } else if (!value(setting.target)) {
    return false;
  }
  setting.place.length = in_.length_since(setting.place.begin);
  if (!in_.accept('='))
    return fail_here("bad_expression",
                     "'=' is missing; a parameter is set as in #1=5 or #<name>=[#1+1]");
  if (!value(setting.value)) return false;
  out_.plain_move = false;
  out_.settings.push_back(setting);
  return true;
}

// ---- values ----------------------------------------------------------------------------------

// A plain number needs no instructions; everything else is compiled.
bool LineParser::value(Value& out) {
  const char c = in_.peek();
  if (is_digit(c) || c == '.' || c == '-' || c == '+') {
    const std::uint32_t begin = in_.position();
    const bool negative = c == '-';
    if (negative || c == '+') in_.advance();
    const char next = in_.peek();
    if (is_digit(next) || next == '.') {
      if (!in_.read_digits(out.number))
        return fail_from("bad_number", begin, "a number needs at least one digit");
      if (!std::isfinite(out.number))
        return fail_from("bad_number", begin, "the number is too large; keep it below 1e308");
      if (in_.peek() == '.')
        return fail_here("bad_number", "a second decimal point; a number has at most one");
      if (in_.peek() == ',')
        return fail_here("bad_number",
                         "a comma inside a number; decimals are written with a point");
      if (negative) out.number = -out.number;
      out.count = 0;
      return true;
    }
    in_.go_to(begin);
  }
  out.first = static_cast<std::uint32_t>(out_.code.size());
  if (!operand()) return false;
  out.count = static_cast<std::uint32_t>(out_.code.size()) - out.first;
  if (out.count == 1 && out_.code.back().op == Op::number) {
    out.number = out_.code.back().number;
    out.count = 0;
    out_.code.pop_back();
  }
  return true;
}

// A value as it may stand behind a letter or between operators.
bool LineParser::operand() {
  const std::uint32_t begin = in_.position();
  const char c = in_.peek();
  if (c == '[') return expression_in_brackets();
  if (c == '#') return parameter(false);
  if (c == '-' || c == '+') {
    if (++depth_ > max_bracket_depth)
      return fail_here("bad_expression", "more than 64 brackets and signs inside each other");
    in_.advance();
    if (!operand()) return false;
    --depth_;
    if (c == '-') emit(Op::negate, {begin, 1});
    return true;
  }
  if (is_letter(c)) return function(begin);
  if (is_digit(c) || c == '.') {
    double number = 0;
    if (!in_.read_digits(number))
      return fail_from("bad_number", begin, "a number needs at least one digit");
    if (!std::isfinite(number))
      return fail_from("bad_number", begin, "the number is too large; keep it below 1e308");
    if (in_.peek() == '.')
      return fail_here("bad_number", "a second decimal point; a number has at most one");
    emit(Op::number, {begin, in_.length_since(begin)}, number);
    return true;
  }
  if (in_.at_end())
    return fail("bad_number", begin, 0, "a value is missing at the end of the line");
  return fail_here("bad_number", "a value is missing before " + quoted(c) +
                                     "; write a number, #parameter, [expression] or function");
}

bool LineParser::expression_in_brackets() {
  const std::uint32_t begin = in_.position();
  if (++depth_ > max_bracket_depth)
    return fail_here("bad_expression", "more than 64 brackets and signs inside each other");
  in_.advance();
  if (!climb(1)) return false;
  if (!in_.accept(']')) {
    if (in_.at_end())
      return fail_from("bad_expression", begin, "the bracket '[' is not closed; add ']'");
    if (is_letter(in_.peek()))
      return fail_here("unknown_operator",
                       "not an operator; known are ** * / MOD + - EQ NE GT GE LT LE AND OR XOR");
    return fail_here("bad_expression",
                     "expected an operator or ']' instead of " + quoted(in_.peek()));
  }
  --depth_;
  return true;
}

const Operator* LineParser::peek_operator() {
  const std::uint32_t begin = in_.position();
  const char c = in_.peek();
  if (c == ']' || in_.at_end()) return nullptr;
  for (const Operator& op : operators) {
    if (op.name[0] != c) continue;
    const bool found = in_.accept_word(op.name);
    in_.go_to(begin);
    if (found) return &op;
  }
  return nullptr;
}

bool LineParser::climb(int level) {
  if (!operand()) return false;
  while (true) {
    const Operator* op = peek_operator();
    if (!op || op->level < level) return true;
    const std::uint32_t begin = in_.position();
    in_.accept_word(op->name);
    const Place place{begin, in_.length_since(begin)};
    if (!climb(op->level + 1)) return false;
    emit(op->op, place);
  }
}

bool LineParser::function(std::uint32_t begin) {
  for (const Function& known : functions) {
    if (!in_.accept_word(known.name)) continue;
    if (is_letter(in_.peek())) {  // the beginning of another name
      in_.go_to(begin);
      continue;
    }
    const Place place{begin, in_.length_since(begin)};
    if (in_.peek() != '[')
      return fail_from(
          "bad_expression", begin,
          std::string("the function ") + known.name + " needs its argument in brackets");
    if (known.op == Op::exists) return exists(begin);
    if (!expression_in_brackets()) return false;
    if (known.op == Op::atan) {
      if (!in_.accept('/'))
        return fail_here("bad_expression", "ATAN needs two arguments: atan[y]/[x]");
      if (in_.peek() != '[')
        return fail_here("bad_expression", "the second argument of ATAN must be in brackets");
      if (!expression_in_brackets()) return false;
    }
    emit(known.op, place);
    return true;
  }
  std::uint32_t end = begin;
  const std::string_view line = in_.line();
  while (end < line.size() && is_letter(static_cast<char>(line[end] | 32))) ++end;
  const std::string_view name = line.substr(begin, end - begin);
  if (name.size() == 1 || !in_.line().substr(end).starts_with("["))
    return fail("bad_number", begin, end - begin,
                "a value is missing before '" + printable(name) +
                    "'; write a number, #parameter, [expression] or function");
  std::vector<std::string> known;
  for (const Function& f : functions) known.emplace_back(f.name);
  std::string lower(name);
  for (char& c : lower) c = static_cast<char>(c | 32);
  return fail("unknown_function", begin, end - begin,
              "there is no function '" + printable(name) + "'." + did_you_mean(lower, known));
}

bool LineParser::exists(std::uint32_t begin) {
  in_.advance();  // the bracket
  if (in_.peek() != '#')
    return fail_here("bad_expression", "EXISTS takes a parameter, e.g. EXISTS[#<name>]");
  if (!parameter(true)) return false;
  if (!in_.accept(']'))
    return fail_here("bad_expression", "EXISTS takes a single parameter; ']' is missing");
  static_cast<void>(begin);
  return true;
}

bool LineParser::parameter(bool only_exists) {
  const std::uint32_t begin = in_.position();
  in_.advance();
  if (in_.peek() == '<') {
    const auto name = name_in_angles();
    if (!name) return false;
    if (parameters_.too_many_names())
      return fail_from("limit_reached", begin, "more than 100000 named parameters");
    emit(only_exists ? Op::exists_named : Op::read_named, {begin, in_.length_since(begin)}, 0,
         parameters_.intern(*name));
    return true;
  }
  if (++depth_ > max_bracket_depth)
    return fail_here("bad_expression", "more than 64 brackets and signs inside each other");
  const std::size_t first = out_.code.size();
  if (!operand()) return false;
  --depth_;
  const Place place{begin, in_.length_since(begin)};
  if (only_exists) {
    emit(Op::exists, place);
    return true;
  }
  // A constant number is looked up without the stack.
  if (out_.code.size() == first + 1 && out_.code.back().op == Op::number) {
    const auto index = as_integer(out_.code.back().number);
    if (!index)
      return fail_from("parameter_range", begin, "a parameter's number must be an integer");
    out_.code.pop_back();
    emit(Op::read, place, 0, *index);
    return true;
  }
  emit(Op::read_indirect, place);
  return true;
}

std::optional<std::string> LineParser::name_in_angles() {
  const std::uint32_t begin = in_.position();
  in_.advance();
  std::string name;
  while (!in_.at_end() && in_.peek() != '>') {
    if (in_.peek() == '<' || in_.peek() == '(' || in_.peek() == ';') break;
    name += in_.peek();
    in_.advance();
  }
  if (!in_.accept('>')) {
    fail_from("bad_parameter_name", begin, "the name is not closed; add '>'");
    return std::nullopt;
  }
  if (name.empty()) {
    fail_from("bad_parameter_name", begin, "a name between '<' and '>' is missing");
    return std::nullopt;
  }
  return name;
}

// ---- O-words ---------------------------------------------------------------------------------

bool LineParser::label() {
  const std::uint32_t begin = in_.position();
  OWord& oword = out_.oword;
  if (in_.peek() == '<') {
    const auto name = name_in_angles();
    if (!name) return false;
    oword.label = *name;
    return true;
  }
  if (is_digit(in_.peek())) {
    double number = 0;
    in_.read_digits(number);
    const auto integer = as_integer(number);
    if (!integer)
      return fail_from("bad_label", begin, "the number of an O-word must be an integer");
    oword.label = std::to_string(*integer);
    return true;
  }
  if (in_.peek() == '[' || in_.peek() == '#') {
    Value computed;
    if (!value(computed)) return false;
    if (const auto constant = constant_value(computed, out_.code)) {
      const auto integer = as_integer(*constant);
      if (!integer)
        return fail_from("bad_label", begin, "the number of an O-word must be an integer");
      oword.label = std::to_string(*integer);
      return true;
    }
    for (std::uint32_t i = begin; i < begin + in_.length_since(begin); ++i) {
      const char c = in_.line()[i];
      if (c != ' ' && c != '\t')
        oword.label += static_cast<char>(c >= 'A' && c <= 'Z' ? c + 32 : c);
    }
    oword.computed = computed;
    return true;
  }
  return fail_here("bad_label",
                   "an O-word needs a number, <name> or [expression], e.g. o100 or o<pocket>");
}

bool LineParser::oword() {
  OWord& oword = out_.oword;
  oword.place.begin = in_.position();
  in_.advance();
  if (!label()) return false;
  if (in_.at_end() || in_.peek() == '(' || in_.peek() == ';') {
    oword.keyword = Keyword::fanuc_sub;
    oword.place.length = in_.length_since(oword.place.begin);
    return only_comments_left();
  }
  const std::uint32_t begin = in_.position();
  for (const KeywordName& known : keywords) {
    if (!in_.accept_word(known.name)) continue;
    oword.keyword = known.keyword;
    break;
  }
  oword.place.length = in_.length_since(oword.place.begin);
  if (oword.keyword == Keyword::none) {
    std::uint32_t end = begin;
    while (end < in_.line().size() && is_letter(static_cast<char>(in_.line()[end] | 32))) ++end;
    std::vector<std::string> known;
    for (const KeywordName& k : keywords) known.emplace_back(k.name);
    return fail("unknown_keyword", begin, std::max(end - begin, 1u),
                "not a keyword of flow control." +
                    did_you_mean(std::string(in_.line().substr(begin, end - begin)), known));
  }
  return oword_arguments();
}

bool LineParser::oword_arguments() {
  OWord& oword = out_.oword;
  std::size_t at_least = 0, at_most = 0;
  const char* needs = "";
  switch (oword.keyword) {
    case Keyword::call:
      at_most = 30;
      break;
    case Keyword::endsub:
    case Keyword::return_:
      at_most = 1;
      break;
    case Keyword::if_:
    case Keyword::elseif:
    case Keyword::while_:
      at_least = at_most = 1;
      needs = "a condition in brackets, e.g. [#1 lt 5]";
      break;
    case Keyword::repeat:
      at_least = at_most = 1;
      needs = "the number of passes in brackets, e.g. [5]";
      break;
    default:
      break;
  }
  while (in_.peek() == '[') {
    const std::uint32_t begin = in_.position();
    Value argument;
    if (!value(argument)) return false;
    oword.arguments.push_back(argument);
    oword.argument_places.push_back({begin, in_.length_since(begin)});
    if (oword.arguments.size() > at_most)
      return fail_from("flow_syntax", begin,
                       at_most == 30 ? "a call takes at most 30 arguments"
                                     : "too many values in brackets on this line");
  }
  if (oword.arguments.size() < at_least)
    return fail("flow_syntax", oword.place.begin, oword.place.length,
                std::string("this line needs ") + needs);
  return only_comments_left();
}

bool LineParser::only_comments_left() {
  while (!in_.at_end()) {
    if (in_.peek() == '(') {
      if (!comment()) return false;
    } else if (in_.peek() == ';') {
      semicolon();
    } else {
      return fail_here("flow_syntax",
                       "only a comment may follow on a line with an O-word; use a line of its own");
    }
  }
  return true;
}

}  // namespace

void Block::clear() {
  length = 0;
  block_delete = false;
  empty = true;
  has_rules = false;
  plain_move = true;
  letters = 0;
  has_expressions = false;
  words.clear();
  slot.fill(-1);
  settings.clear();
  comment.reset();
  if (oword.keyword != Keyword::none || !oword.label.empty()) oword = OWord{};
  code.clear();
  following = nullptr;
}

std::optional<Fault> parse_line(std::string_view line, Parameters& parameters,
                                const CodeTable& table, Block& out) {
  return LineParser(line, parameters, table, out).parse();
}

std::optional<double> constant_value(const Value& value, const Code& code) {
  if (value.constant()) return value.number;
  for (std::uint32_t i = 0; i < value.count; ++i) {
    const Op op = code[value.first + i].op;
    if (op >= Op::read && op <= Op::exists_named) return std::nullopt;
  }
  class NoLive final : public LiveValues {
    std::optional<double> numbered(int, Place, std::optional<Fault>&) const override {
      return std::nullopt;
    }
    double predefined(int) const override { return 0; }
  };
  const NoLive live;
  const Parameters none(live, {});
  std::optional<Fault> fault;
  return evaluate(value, code, none, fault);
}

}  // namespace aircut::interp
