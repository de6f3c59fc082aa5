// O-words: label, keyword, values in brackets; nothing else may stand on the line.
#include <algorithm>
#include <array>

#include "interp/line_parser.h"
#include "interp/parser.h"

namespace aircut::interp {
namespace {

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

}  // namespace

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
  while (true) {
    while (oword.keyword == Keyword::call && in_.peek() == '(')
      if (!comment()) return false;
    if (in_.peek() != '[') break;
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

}  // namespace aircut::interp
