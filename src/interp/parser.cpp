// Words, comments and settings of a line.
#include "interp/parser.h"

#include "interp/dialect.h"
#include "interp/line_parser.h"

namespace aircut::interp {
namespace {

constexpr int max_g_words = 20;  // as many as there are modal groups

}  // namespace

std::optional<Fault> LineParser::parse() {
  if (in_.at_end()) return std::nullopt;
  out_.empty = false;
  const std::uint32_t max_line_length = table_.dialect().max_line;
  if (max_line_length != 0 && in_.line().size() > max_line_length) {
    fail("line_too_long", max_line_length,
         static_cast<std::uint32_t>(in_.line().size()) - max_line_length,
         "the line has " + std::to_string(in_.line().size()) + " characters; the control takes " +
             std::to_string(max_line_length) + ", split it");
    return fault_;
  }
  if (table_.dialect().macro_b) return parse_macro_b();
  if (in_.accept('/')) out_.block_delete = true;
  if (in_.peek() == 'n' && !line_number()) return fault_;
  if (in_.peek() == 'o') {
    oword();
    return fault_;
  }
  plain_words();
  while (!fault_ && !in_.at_end())
    if (!item()) break;
  return fault_;
}

// What programs mostly consist of, a letter and a number as it is mostly written, in one go. It
// stops in front of anything else.
void LineParser::plain_words() {
  for (char c = in_.peek(); is_letter(c) && c != 'n' && c != 'o'; c = in_.peek()) {
    const std::uint32_t begin = in_.position();
    in_.advance();
    double number = 0;
    std::uint32_t end = 0;
    if (!in_.read_plain_number(number, end)) return in_.go_to(begin);
    Word& word = out_.words.emplace_back();
    word.letter = static_cast<char>(c - 32);
    word.place = {begin, end - begin};
    word.text.number = number;
    if (add_word(word)) continue;
    return out_.words.pop_back();
  }
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
  if (is_letter(c)) return word(c);
  if (c == '(') return comment();
  if (c == ';') return semicolon();
  if (c == '#') return setting();
  if (c == '$' || c == '@' || c == '^') return word(c);
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
  if (letter == 'n' || letter == 'o') return misplaced_word(letter);
  return word_behind(in_.position(), is_letter(letter) ? static_cast<char>(letter - 32) : letter);
}

// The value of a word that begins at `begin`; the cursor stands on its letter. The word is made
// where it stays; a refused one is taken away again.
bool LineParser::word_behind(std::uint32_t begin, char letter) {
  const std::size_t before = out_.words.size();
  Word& word = out_.words.emplace_back();
  word.place.begin = begin;
  word.letter = letter;
  in_.advance();
  if (table_.dialect().macro_b ? read_macro_word(word) : read_word(word)) return true;
  out_.words.resize(before);
  return false;
}

bool LineParser::misplaced_word(char letter) {
  if (letter == 'n') return fail_here("misplaced_word", "N must be the first word of the line");
  return fail_here("misplaced_word", "an O-word must be the first word of the line (after N)");
}

bool LineParser::read_word(Word& word) {
  std::uint32_t end = 0;
  if (in_.read_plain_number(word.text.number, end)) {
    word.place.length = end - word.place.begin;
  } else {
    if (!value(word.text)) return false;
    word.place.length = in_.length_since(word.place.begin);
  }
  return add_word(word);
}

// `word` is the last one of the block.
bool LineParser::add_word(Word& word) {
  const std::uint32_t bit = letter_bit(word.letter);
  bool plain = (bit & move_letters) != 0;
  if (word.letter == 'G' || word.letter == 'M') {
    out_.has_rules = true;
    int& count = word.letter == 'G' ? g_groups_ : m_words_;
    if (++count > (word.letter == 'G' ? max_g_words : table_.dialect().max_m_words))
      return too_many_codes(word);
    if (word.text.constant()) word.rule = table_.find(word.letter, word.text.number);
    plain = word.rule && word.letter == 'G' && word.rule->code <= 30 && word.rule->code % 10 == 0 &&
            g_groups_ == 1;
    out_.plain_rule = word.rule;
  } else {
    auto& slot = out_.slot[static_cast<std::size_t>(letter_index(word.letter))];
    if (slot >= 0) return second_word(word);
    slot = static_cast<std::int8_t>(out_.words.size() - 1);
  }
  if (!plain) out_.plain_move = false;
  out_.letters |= bit;
  if (word.text.constant())
    word.number = word.text.number;
  else
    out_.has_expressions = true;
  return true;
}

bool LineParser::too_many_codes(const Word& word) {
  if (word.letter == 'G')
    return fail("modal_clash", word.place.begin, word.place.length,
                "more G words on this line than there are modal groups");
  return fail("too_many_m", word.place.begin, word.place.length,
              "more than " + std::to_string(table_.dialect().max_m_words) +
                  " M words on one line; put the others on a line of their own");
}

bool LineParser::second_word(const Word& word) {
  return fail("duplicate_word", word.place.begin, word.place.length,
              std::string("a second ") + word.letter + " word on this line; one is allowed");
}

bool LineParser::setting() {
  Setting setting;
  setting.place.begin = in_.position();
  in_.advance();
  if (table_.dialect().macro_b) return macro_setting(setting);
  if (in_.peek() == '<') {
    const auto name = name_in_angles();
    if (!name) return false;
    if (parameters_.too_many_names())
      return fail_from("limit_reached", setting.place.begin, "more than 100000 named parameters");
    setting.name = parameters_.intern(*name);
  } else if (!value(setting.target)) {
    return false;
  } else if (setting.target.constant()) {
    const int number = as_integer(setting.target.number).value_or(0);
    if (Parameters::always_readable(number)) setting.plain = number;
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

void Block::clear() {
  length = 0;
  block_delete = false;
  number = -1;
  plain_settings = true;
  empty = true;
  has_rules = false;
  plain_move = true;
  plain_rule = nullptr;
  letters = 0;
  has_expressions = false;
  words.clear();
  slot.fill(-1);
  settings.clear();
  macro_words.clear();
  warnings.clear();
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
    const Instruction& at = code[value.first + i];
    if (at.op >= Op::read && at.op <= Op::exists_named) return std::nullopt;
    if (at.right == Right::parameter) return std::nullopt;
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
