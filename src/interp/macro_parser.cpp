// Lines of Fanuc-like controls: program headers, block numbers anywhere, statements of macro B.
// A block is either words or one statement; both may have an N word and comments.
#include <algorithm>
#include <array>

#include "interp/dialect.h"
#include "interp/line_parser.h"

namespace aircut::interp {
namespace {

constexpr std::size_t max_macro_words = 100;
constexpr std::size_t max_settings = 50;

struct Statement {
  const char* name;
  Keyword keyword;
};
// THEN only to say where it belongs.
constexpr std::array<Statement, 11> statements = {{{"if", Keyword::if_goto},
                                                   {"while", Keyword::while_do},
                                                   {"do", Keyword::while_do},
                                                   {"end", Keyword::end_},
                                                   {"goto", Keyword::goto_},
                                                   {"dprnt", Keyword::output},
                                                   {"bprnt", Keyword::output},
                                                   {"setvn", Keyword::nothing},
                                                   {"popen", Keyword::nothing},
                                                   {"pclos", Keyword::nothing},
                                                   {"then", Keyword::none}}};

bool is_macro_call(const Word& word) {
  return word.letter == 'G' && word.text.constant() &&
         (word.text.number == 65 || word.text.number == 66 || word.text.number == 66.1);
}

}  // namespace

std::optional<Fault> LineParser::parse_macro_b() {
  if (in_.accept('/')) {
    out_.block_delete = true;
    // The number of the switch; a block number or an address follows.
    if (is_digit(in_.peek()) && in_.peek() != '0') in_.advance();
  }
  while (!in_.at_end())
    if (!macro_item()) break;
  const bool statement =
      out_.oword.keyword != Keyword::none && out_.oword.keyword != Keyword::program;
  const bool conditional = out_.oword.keyword == Keyword::if_m99 && out_.settings.empty();
  if (!fault_ && conditional && !returns_only())
    fail("flow_syntax", out_.oword.place.begin, out_.oword.place.length,
         "behind a condition without IF stands M99 with or without P, e.g. [#1 LT 5] M99 P10");
  if (!fault_ && !conditional && !out_.words.empty() && (statement || !out_.settings.empty()))
    fail("mixed_block", out_.words.front().place.begin, out_.words.front().place.length,
         "words and a macro statement stand in one block; give each a block of its own");
  if (statement || !out_.settings.empty() || out_.oword.keyword != Keyword::none)
    out_.plain_move = false;
  return fault_;
}

bool LineParser::macro_item() {
  const char c = in_.peek();
  if (c == ';') return end_of_block();
  if (c == 'o' || c == ':') return program_header();
  if (is_letter(c))
    if (const auto done = macro_statement()) return *done;
  if (c == 'n') return block_number();
  if (c == '@' || c == '^' || c == '$')
    return fail_here("bad_character", "the character " + quoted(c) + " can't be used here");
  if (c == ',') return comma_word();
  if (c == '[' && table_.dialect().return_jumps) return conditional_return();
  if (c == '/')
    return fail_here("bad_character",
                     "'/' (block skip) inside a block is not supported; put the words that may be "
                     "skipped into a block of their own");
  return item();
}

// [c] M99 P…: the words of the block count when the condition is true.
bool LineParser::conditional_return() {
  const std::uint32_t begin = in_.position();
  if (!out_.words.empty() || out_.oword.keyword != Keyword::none)
    return fail_here("bad_character", "a condition stands in front of M99, e.g. [#1 LT 5] M99 P10");
  out_.oword.keyword = Keyword::if_m99;
  if (!condition()) return false;
  out_.oword.place = {begin, in_.length_since(begin)};
  return true;
}

bool LineParser::returns_only() const {
  bool returns = false;
  for (const Word& word : out_.words) {
    returns = returns || (word.letter == 'M' && word.text.constant() && word.text.number == 99);
    if (word.letter != 'P' && word.letter != 'M') return false;
  }
  return returns;
}

// ,R and ,C for corners, ,A for the angle of a line.
bool LineParser::comma_word() {
  const std::uint32_t begin = in_.position();
  in_.advance();
  const char letter = in_.peek();
  if (letter == 'a' || letter == 'c' || letter == 'r') return word_behind(begin, letter);
  return fail_from("bad_character", begin,
                   "behind a comma stands R, C (a corner) or A (an angle); decimals are written "
                   "with a point");
}

// The control takes `;` for the end of the block, so what follows would be another block.
bool LineParser::end_of_block() {
  const std::uint32_t begin = in_.position();
  in_.advance();
  while (in_.accept(';')) {
  }
  if (in_.at_end()) return true;
  if (in_.peek() == '(') return comment();
  return fail("bad_comment", begin, static_cast<std::uint32_t>(in_.line().size()) - begin,
              "';' ends the block on this control; comments stand in ( ), another block on a line "
              "of its own");
}

bool LineParser::program_header() {
  const std::uint32_t begin = in_.position();
  if (!out_.words.empty() || out_.oword.keyword != Keyword::none)
    return fail_here("misplaced_word", "a program number stands at the beginning of its block");
  in_.advance();
  double number = 0;
  if (!in_.read_digits(number))
    return fail_from("bad_label", begin, "a program has a number, e.g. O1234");
  const auto integer = as_integer(number);
  if (!integer || *integer == 0)
    return fail_from("bad_label", begin, "the number of a program must be an integer above 0");
  out_.oword.keyword = Keyword::program;
  out_.oword.label = std::to_string(*integer);
  out_.oword.place = {begin, in_.length_since(begin)};
  return true;
}

bool LineParser::block_number() {
  const std::uint32_t begin = in_.position();
  in_.advance();
  double number = 0;
  if (!in_.read_digits(number))
    return fail_from("bad_number", begin, "N needs a block number, e.g. N100");
  const auto integer = as_integer(number);
  if (!integer) return fail_from("bad_number", begin, "a block number must be an integer");
  if (out_.number >= 0)
    return fail_from("duplicate_word", begin, "a second block number; one is allowed");
  out_.number = *integer;
  return true;
}

// Nothing when the letters are not a statement.
std::optional<bool> LineParser::macro_statement() {
  const std::uint32_t begin = in_.position();
  for (const Statement& known : statements) {
    if (!in_.accept_word(known.name)) continue;
    if (!out_.words.empty())
      return fail_from("mixed_block", begin,
                       "words and a macro statement stand in one block; give each a block of its "
                       "own");
    if (out_.oword.keyword != Keyword::none)
      return fail_from("flow_syntax", begin, "only one macro statement can stand in a block");
    switch (known.keyword) {
      case Keyword::if_goto:
        return macro_if(begin);
      case Keyword::while_do:
        if (known.name[0] == 'd') return loop_number(begin, Keyword::while_do);
        return macro_while(begin);
      case Keyword::end_:
        return loop_number(begin, Keyword::end_);
      case Keyword::goto_:
        return macro_goto(begin, Keyword::goto_);
      case Keyword::output:
        return output_statement(begin);
      case Keyword::nothing:
        out_.oword.keyword = Keyword::nothing;
        out_.oword.place = {begin, in_.length_since(begin)};
        in_.go_to(static_cast<std::uint32_t>(in_.line().size()));
        return true;
      default:
        return fail_from("flow_syntax", begin, "THEN belongs behind IF and its condition");
    }
  }
  return std::nullopt;
}

bool LineParser::condition() {
  const std::uint32_t begin = in_.position();
  if (in_.peek() != '[' && !table_.dialect().bare_conditions)
    return fail_here("flow_syntax", "a condition in brackets is missing, e.g. [#1 LT 5]");
  Value value;
  brackets_ = -1;  // those of the condition itself do not count
  if (!whole_expression(value)) return false;
  brackets_ = 0;
  out_.oword.arguments.push_back(value);
  out_.oword.argument_places.push_back({begin, in_.length_since(begin)});
  return true;
}

bool LineParser::macro_if(std::uint32_t begin) {
  out_.oword.keyword = Keyword::if_goto;
  out_.oword.place.begin = begin;
  if (!condition()) return false;
  const std::uint32_t behind = in_.position();
  if (in_.accept_word("goto")) return macro_goto(behind, Keyword::if_goto);
  if (!in_.accept_word("then"))
    return fail("flow_syntax", behind, in_.at_end() ? 0 : 1,
                "behind the condition of IF stands GOTO and a block number, or THEN and a setting");
  if (in_.accept_word("goto")) return macro_goto(behind, Keyword::if_goto);
  out_.oword.keyword = Keyword::if_then;
  if (in_.peek() != '#')
    return fail_here("flow_syntax", "behind THEN stands a setting, e.g. THEN #1=0");
  if (!setting()) return false;
  out_.oword.place.length = in_.length_since(begin);
  return true;
}

bool LineParser::macro_goto(std::uint32_t begin, Keyword keyword) {
  out_.oword.keyword = keyword;
  if (keyword == Keyword::goto_) out_.oword.place.begin = begin;
  const std::uint32_t at = in_.position();
  Value target;
  if (!value(target)) return false;
  make_solid_value(target);
  out_.oword.arguments.push_back(target);
  out_.oword.argument_places.push_back({at, in_.length_since(at)});
  out_.oword.place.length = in_.length_since(out_.oword.place.begin);
  return true;
}

bool LineParser::macro_while(std::uint32_t begin) {
  if (!condition()) return false;
  const std::uint32_t behind = in_.position();
  if (!in_.accept_word("do"))
    return fail("flow_syntax", behind, in_.at_end() ? 0 : 1,
                "behind the condition of WHILE stands DO1, DO2 or DO3");
  return loop_number(begin, Keyword::while_do);
}

bool LineParser::loop_number(std::uint32_t begin, Keyword keyword) {
  out_.oword.keyword = keyword;
  const std::uint32_t at = in_.position();
  double number = 0;
  if (!in_.read_digits(number) || (number != 1 && number != 2 && number != 3))
    return fail("flow_syntax", at, std::max(1u, in_.length_since(at)),
                "the number of a loop is 1, 2 or 3, e.g. DO1 and END1");
  out_.oword.label = std::to_string(static_cast<int>(number));
  out_.oword.place = {begin, in_.length_since(begin)};
  return true;
}

// The text between the outer brackets is read when it is written out.
bool LineParser::output_statement(std::uint32_t begin) {
  out_.oword.keyword = Keyword::output;
  const std::string_view line = in_.line();
  const std::uint32_t open = in_.position();
  if (in_.peek() != '[')
    return fail_here("flow_syntax", "what to write stands in brackets, e.g. DPRNT[X#100[43]]");
  int depth = 0;
  for (std::uint32_t at = open; at < line.size(); ++at) {
    depth += line[at] == '[' ? 1 : line[at] == ']' ? -1 : 0;
    if (depth != 0) continue;
    out_.oword.place = {begin, at + 1 - begin};
    out_.oword.argument_places.push_back({open + 1, at - open - 1});
    in_.go_to(at + 1);
    return true;
  }
  return fail("bad_expression", open, static_cast<std::uint32_t>(line.size()) - open,
              "the bracket '[' is not closed; add ']'");
}

bool LineParser::read_macro_word(Word& word) {
  const std::uint32_t begin = in_.position();
  address_ = word.letter;
  if (!value(word.text)) return false;
  address_ = 0;
  word.place.length = in_.length_since(word.place.begin);
  const std::string_view text = in_.line().substr(begin, in_.length_since(begin));
  word.no_point = word.text.constant() && text.find_first_of(".[") == std::string_view::npos;
  return add_macro_word(word);
}

// `word` is the last one of the block. The last one of a letter counts, except for the arguments of
// a macro, which may repeat I J K.
bool LineParser::add_macro_word(Word& word) {
  if (macro_words_ && word.letter != 'P' && word.letter != 'L') {
    if (word.letter == 'G')
      return fail("word_unused", word.place.begin, word.place.length,
                  "G can't be an argument of a macro; the arguments follow G65 P…");
    if (out_.macro_words.size() >= max_macro_words)
      return fail("limit_reached", word.place.begin, word.place.length,
                  "more than 100 arguments of a macro");
    out_.macro_words.push_back(word);
    out_.words.pop_back();
    return true;
  }
  if (word.letter != 'G' && word.letter != 'M') {
    const int before = out_.slot[static_cast<std::size_t>(letter_index(word.letter))];
    if (before >= 0) {
      out_.warnings.push_back({"duplicate_word", word.place,
                               std::string("a second ") + word.letter +
                                   " word in this block; the control takes the last one"});
      out_.plain_move = false;
      if (!word.text.constant()) out_.has_expressions = true;
      word.number = word.text.number;
      out_.words[static_cast<std::size_t>(before)] = word;
      out_.words.pop_back();
      return true;
    }
  }
  if (!add_word(word)) return false;
  if (is_macro_call(word)) macro_words_ = true;
  // Words in increments, and rounding to them, are the executor's business.
  if (!word.text.constant() || (word.no_point && word.text.number != 0)) out_.plain_move = false;
  return true;
}

bool LineParser::macro_setting(Setting& setting) {
  if (in_.peek() == '<')
    return fail_from("bad_parameter_name", setting.place.begin,
                     "variables have numbers on this control, e.g. #100; #<name> is LinuxCNC's");
  if (out_.settings.size() >= max_settings)
    return fail_here("limit_reached", "more than 50 settings in one block");
  if (!value(setting.target)) return false;
  make_solid_value(setting.target);
  setting.place.length = in_.length_since(setting.place.begin);
  if (!in_.accept('='))
    return fail_here("bad_expression", "'=' is missing; a variable is set as in #1=#2+5");
  if (!whole_expression(setting.value)) return false;
  out_.plain_move = false;
  if (!setting.target.constant() || setting.target.number >= Parameters::first_system)
    out_.plain_settings = false;
  out_.settings.push_back(setting);
  return true;
}

}  // namespace aircut::interp
