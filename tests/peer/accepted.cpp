#include "peer/accepted.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>
#include <functional>
#include <regex>
#include <sstream>
#include <utility>
#include <vector>

#include "base/text.h"

namespace aircut::test {
namespace {

struct Rule {
  const char* said;
  const char* name;
};

/// What only we refuse, or at an earlier line, by what we say. docs/peer.md has the reasons.
constexpr Rule refused_here_only[] = {
    // Radius compensation: a move that is too short for the tool runs backwards there, or comes to
    // light with the next move.
    {"too short between its corners", "compensation: short move"},
    {"the move before it is too short", "compensation: short move"},
    {"no arc leads from here to the start", "compensation: entry by an arc that comes backwards"},
    {"begins with a straight move, not with an arc", "compensation: entry by an arc with a nose"},
    {"splines can't be used while radius compensation", "compensation: splines"},
    {"G76 can't be used while radius compensation", "compensation: G76"},
    {"G17.1 can't be used while radius compensation", "compensation: G17.1"},
    {"G18.1 can't be used while radius compensation", "compensation: G17.1"},
    {"G19.1 can't be used while radius compensation", "compensation: G17.1"},
    {"G92.1 can't be used while radius compensation", "compensation: G92.1"},
    {"G92.2 can't be used while radius compensation", "compensation: G92.1"},
    {"G92.3 can't be used while radius compensation", "compensation: G92.1"},
    {"must be an integer from", "integers"},
    {"I and J of G5.1 can't both be 0", "splines"},
    {"splines need the XY plane", "splines"},
    {"G5 with feed", "splines without a feed"},
    {"G5.1 with feed", "splines without a feed"},
    {"G5.2 with feed", "splines without a feed"},
    {"in G93 every G5", "splines without a feed"},
    {"in G93 F must be above 0", "G93 F0"},
    {"I, the speed factor of the way back", "G33.1 I"},
    {"D, the highest spindle speed, must be above 0", "G96 D0"},
    {"at the origin the angle is not defined", "a polar hole at the origin"},
    {"G76 moves X and Z only", "G76"},
    {"the tapers of the thread are longer", "G76"},
    {"the distance per revolution, must be above 0", "pitch"},
    {"the control moves the wrong axes", "tapping outside of G17"},
    {"not a finite number", "conditions without a value"}};

/// What only the reference refuses, by what it says.
constexpr Rule refused_there_only[] = {
    {"without gouging", "compensation: a corner that is just reached"},
    {"spindle ($) number in M51", "M51 $"},
    {"D word with no", "G83 D"},
    {"Requested tool -1 not found", "G43.2 with axis words"}};

/// How the reference calls what it can't read, with or without executing it.
constexpr const char* unreadable[] = {"Unclosed comment found", "Nested comment found",
                                      "Non integer value for integer"};

const Rule* rule_in(const Rule* begin, const Rule* end, const std::string& text) {
  const Rule* found = std::find_if(
      begin, end, [&](const Rule& rule) { return text.find(rule.said) != std::string::npos; });
  return found == end ? nullptr : found;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The program without the lines for which `gone` is true, or nothing when there is none.
std::string without(const std::string& program,
                    const std::function<bool(std::size_t number, const std::string& line)>& gone) {
  std::string rest;
  bool any = false;
  std::size_t number = 0;
  for (const std::string& line : lines_of(program)) {
    if (gone(++number, line))
      any = true;
    else
      rest += line + "\n";
  }
  return any ? rest : std::string();
}

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r\n");
  return first == std::string::npos
             ? std::string()
             : text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
}

/// The line that the reference refused, which it repeats behind its message.
std::string refused_line(const Trace& reference) {
  std::string last;
  for (const std::string& line : lines_of(reference.error_text))
    if (!trimmed(line).empty()) last = trimmed(line);
  return last;
}

std::string without_refused_line(const std::string& program, const Trace& reference) {
  const std::string refused = refused_line(reference);
  if (refused.empty()) return "";
  return without(program, [&](std::size_t, const std::string& l) { return trimmed(l) == refused; });
}

bool acted(const Trace& own, std::initializer_list<const char*> codes) {
  return std::any_of(codes.begin(), codes.end(), [&](const char* code) {
    const auto found = own.codes.find(code);
    return found != own.codes.end() && found->second > 0;
  });
}

/// Whether the two agree but for these calls.
bool agree_without(std::initializer_list<const char*> names, Trace own, Trace reference) {
  for (Trace* trace : {&own, &reference})
    std::erase_if(trace->calls, [&](const Call& call) {
      return std::any_of(names.begin(), names.end(),
                         [&](const char* name) { return call.text.starts_with(name); });
    });
  return !difference(own, reference);
}

/// Positions read as a number of micrometres, and conditions that tell their value from 0 with a
/// band, so that the rounding of positions does not decide.
std::string with_rounded_conditions(const std::string& program) {
  static const std::regex condition(R"(^(\s*o.*\s(?:if|elseif|while)\s*)(\[.*\])\s*$)",
                                    std::regex::icase);
  static const std::regex position(R"((exists\[)?(#<_(?:abs_)?[xyzabc]>|#54(?:2[0-8])))",
                                   std::regex::icase);
  std::string out;
  for (std::string line : lines_of(program)) {
    if (line.find('(') == std::string::npos) {
      line = std::regex_replace(line, position, "$1[round[$2*1000]/1000]");
      line = std::regex_replace(
          line, std::regex(R"(exists\[\[round\[(\S*)\*1000\]/1000\])", std::regex::icase),
          "exists[$1");
    }
    std::smatch match;
    const bool is_one = std::regex_match(line, match, condition);
    out += (is_one ? match.str(1) + "[round[[" + match.str(2) + "]*1000000]]" : line) + "\n";
  }
  return out;
}

/// With each R word a bit larger, and the later ones more, so that no level is met to the last bit,
/// also not that of a cycle before.
std::string with_other_levels(const std::string& program) {
  static const std::regex level(R"((R\s*)([-+]?[0-9]+\.?[0-9]*|[-+]?\.[0-9]+))", std::regex::icase);
  std::string out;
  auto from = program.begin();
  int count = 0;
  for (std::sregex_iterator at(program.begin(), program.end(), level), end; at != end; ++at) {
    const std::string times = ++count == 1 ? "" : "*" + std::to_string(count);
    out.append(from, program.begin() + at->position());
    out += at->str(1) + "[" + at->str(2) + "*1.00137+0.00113" + times + "]";
    from = program.begin() + at->position() + at->length();
  }
  return out.append(from, program.end());
}

/// Without a length offset when the unit changes.
std::string without_offsets_in_other_units(const std::string& program) {
  static const std::regex unit(R"(G\s*2\s*[01](\D|$))", std::regex::icase);
  std::string out;
  for (const std::string& line : lines_of(program))
    out += (std::regex_search(line, unit) ? "G49\n" : "") + line + "\n";
  return out;
}

/// Without feeds to the point where the tool stands, in G18.
Trace without_null_feeds(Trace trace) {
  std::string at;
  std::erase_if(trace.calls, [&](const Call& call) {
    double x = 0, y = 0, z = 0;
    if (std::sscanf(call.text.c_str(), "ARC_FEED(%lf, %lf,", &z, &x) != 2 &&
        std::sscanf(call.text.c_str(), "STRAIGHT_FEED(%lf, %lf, %lf,", &x, &y, &z) != 3 &&
        std::sscanf(call.text.c_str(), "STRAIGHT_TRAVERSE(%lf, %lf, %lf,", &x, &y, &z) != 3)
      return false;
    const std::string before = std::exchange(at, fixed(x, 4) + " " + fixed(z, 4));
    return at == before && call.text.starts_with("STRAIGHT_FEED");
  });
  return trace;
}

/// Up to the first position that is beyond any machine, such as the tangent of 90 degrees: there a
/// rotated frame leaves no digit of the other axis.
Trace up_to_huge_numbers(Trace trace) {
  static const std::regex huge(R"([0-9]{13,}\.)");
  const auto first = std::find_if(trace.calls.begin(), trace.calls.end(), [](const Call& call) {
    return std::regex_search(call.text, huge);
  });
  if (first == trace.calls.end()) return trace;
  trace.calls.erase(first, trace.calls.end());
  trace.error = trace.timed_out = false;
  return trace;
}

/// The value behind `label` in a difference, up to the end of its line.
std::string told(const std::string& difference, const char* label) {
  const std::size_t at = difference.find(label);
  if (at == std::string::npos) return "";
  const std::size_t begin = at + std::string(label).size();
  return difference.substr(begin, difference.find('\n', begin) - begin);
}

class Rules {
 public:
  Rules(const std::string& program, const Trace& own, const Trace& reference,
        const std::string& difference)
      : program_(program), own_(own), reference_(reference), difference_(difference) {}

  std::optional<Excuse> excuse() const;

 private:
  bool is(const char* kind) const { return difference_.starts_with(kind); }
  bool reference_says(const std::string& text) const {
    return reference_.error_text.find(text) != std::string::npos;
  }
  std::optional<Excuse> refused_here() const;
  std::optional<Excuse> refused_there() const;
  std::optional<Excuse> unreadable_line() const;
  std::optional<Excuse> other_rates() const;
  std::optional<Excuse> stand_in_tool() const;
  std::optional<Excuse> stand_in_unit() const;
  std::optional<Excuse> stand_in_reload() const;
  bool same_call() const;
  std::optional<Excuse> probe_of_no_way() const;
  std::optional<Excuse> over_a_pocket() const;
  std::optional<Excuse> rounding() const;

  const std::string& program_;
  const Trace& own_;
  const Trace& reference_;
  const std::string& difference_;
};

std::optional<Excuse> Rules::refused_here() const {
  const bool earlier = is("refused at another line") || is("only own refuses") || is("stopped at");
  const Rule* rule =
      rule_in(std::begin(refused_here_only), std::end(refused_here_only), own_.error_text);
  if (!earlier || !rule || own_.error_at == 0) return std::nullopt;
  return Excuse{rule->name, without(program_, [&](std::size_t number, const std::string&) {
                  return number == own_.error_at;
                })};
}

std::optional<Excuse> Rules::refused_there() const {
  const Rule* rule =
      rule_in(std::begin(refused_there_only), std::end(refused_there_only), reference_.error_text);
  // It prints the calls of a refused line up to where it meets the error.
  const bool in_its_line = is("call");
  if (!rule || !(in_its_line || is("refused at another line") || is("only the reference refuses")))
    return std::nullopt;
  return Excuse{rule->name, without_refused_line(program_, reference_)};
}

// A line that can't be read, between a call and its sub, is met when the call looks for the sub.
std::optional<Excuse> Rules::unreadable_line() const {
  if (!own_.error || !reference_.error) return std::nullopt;
  const bool the_same = is("only own has") && reference_says(own_.error_line.substr(0, 200));
  const bool another = is("refused at another line") &&
                       std::any_of(std::begin(unreadable), std::end(unreadable),
                                   [&](const char* text) { return reference_says(text); });
  if (!the_same && !another) return std::nullopt;
  return Excuse{"unreadable line behind a call", without_refused_line(program_, reference_)};
}

// The rates of moves only. In G93 a move behind G88 is measured from where the operator has put the
// tool. Radius compensation: the reference tells the rate of a move before what it says at once,
// here it comes with the move, which is held back; an F before G20 is told in the wrong unit.
std::optional<Excuse> Rules::other_rates() const {
  const bool rates = agree_without({"SET_FEED_RATE("}, own_, reference_);
  if (rates && acted(own_, {"G88"}) && acted(own_, {"G93"})) return Excuse{"rate behind G88", ""};
  if (rates && acted(own_, {"G41", "G41.1", "G42", "G42.1"}) && acted(own_, {"G93", "G20"}))
    return Excuse{"compensation: rate of a held move", ""};
  // M72 puts G64 P and M51 to M53 on one line, where these read that P.
  if (acted(own_, {"M72"}) && acted(own_, {"G64"}) && acted(own_, {"M51", "M52", "M53"}) &&
      agree_without({"ENABLE_SPEED_OVERRIDE", "DISABLE_SPEED_OVERRIDE", "ENABLE_ADAPTIVE_FEED",
                     "DISABLE_ADAPTIVE_FEED", "ENABLE_FEED_HOLD", "DISABLE_FEED_HOLD"},
                    own_, reference_))
    return Excuse{"M72 with G64 P", ""};
  return std::nullopt;
}

// Without a tool in the spindle G10 L1 P1 loads tool 1 into the stand-in: H0 of a later line takes
// its length.
std::optional<Excuse> Rules::stand_in_tool() const {
  static const std::regex h0(R"(^.*G\s*43(\.2)?[^0-9.].*H\s*0+(\.0*)?(\s.*)?$)", std::regex::icase);
  const auto tells_a_length = [&](const char* label) {
    return told(difference_, label).starts_with("USE_TOOL_LENGTH_OFFSET");
  };
  if (!acted(own_, {"G10"}) || !tells_a_length("own:       ") || !tells_a_length("reference: "))
    return std::nullopt;
  const std::string rest = without(
      program_, [&](std::size_t, const std::string& line) { return std::regex_match(line, h0); });
  if (rest.empty()) return std::nullopt;
  return Excuse{"H0 behind G10 L1 P1 without a tool", rest};
}

// The stand-in gives the length offset of the old unit back as if it were in the new one.
std::optional<Excuse> Rules::stand_in_reload() const {
  static const std::regex reload(R"(^.*G\s*10[^0-9.].*L\s*0+(\.0*)?([^0-9.].*)?$)",
                                 std::regex::icase);
  if (!same_call() || !acted(own_, {"G10"}) || !acted(own_, {"G43", "G43.1", "G43.2"}))
    return std::nullopt;
  const std::string rest = without(program_, [&](std::size_t, const std::string& line) {
    return std::regex_match(line, reload);
  });
  if (rest.empty()) return std::nullopt;
  return Excuse{"the point behind G10 L0", rest};
}

std::optional<Excuse> Rules::stand_in_unit() const {
  if (!same_call() || !acted(own_, {"G20", "G21"}) || !acted(own_, {"G49", "G43.1", "G43.2"}) ||
      !acted(own_, {"G43", "G43.1", "G43.2"}))
    return std::nullopt;
  const std::string rest = without_offsets_in_other_units(program_);
  if (rest == program_ || program_.find("\nG49\n") != std::string::npos) return std::nullopt;
  return Excuse{"a length offset over G20, G21", rest};
}

bool Rules::same_call() const {
  const std::string own = told(difference_, "    own:       ");
  const std::string name = own.substr(0, own.find('('));
  return !name.empty() && told(difference_, "    reference: ").starts_with(name + "(");
}

// There a position that went through inches and back is another one by 1e-16, and the probe moves.
std::optional<Excuse> Rules::probe_of_no_way() const {
  const bool earlier = is("refused at another line") || is("only own refuses") || is("stopped at");
  if (!earlier || !acted(own_, {"G20"}) || !acted(own_, {"G21"}) ||
      own_.error_text.find("the end of the probing move is the current point") == std::string::npos)
    return std::nullopt;
  return Excuse{"rounding decides", without(program_, [&](std::size_t number, const std::string&) {
                  return number == own_.error_at;
                })};
}

// A difference of 1e-16 decides whether the level where a cycle begins is its R, whether a peck
// meets the bottom, or whether a condition is true.
std::optional<Excuse> Rules::rounding() const {
  const Trace own = up_to_huge_numbers(own_), reference = up_to_huge_numbers(reference_);
  const bool cut =
      own.calls.size() < own_.calls.size() && reference.calls.size() < reference_.calls.size();
  if (is("call") && cut && !difference(own, reference))
    return Excuse{"rounding of 13 digits and more", ""};
  const std::string rest = with_other_levels(with_rounded_conditions(program_));
  if (rest == program_ || program_.find("*1.00137+0.00113]") != std::string::npos ||
      program_.find("]*1000000]") != std::string::npos)
    return std::nullopt;
  return Excuse{"rounding decides", rest};
}

// Whether a level line begins at its level or a rounding error below it.
std::optional<Excuse> Rules::over_a_pocket() const {
  if (!acted(own_, {"G71.1", "G72.1"})) return std::nullopt;
  if (difference(without_null_feeds(own_), without_null_feeds(reference_))) return std::nullopt;
  return Excuse{"feeds to where the tool stands", ""};
}

std::optional<Excuse> Rules::excuse() const {
  for (const auto rule :
       {&Rules::refused_here, &Rules::refused_there, &Rules::unreadable_line, &Rules::other_rates,
        &Rules::stand_in_tool, &Rules::stand_in_unit, &Rules::stand_in_reload,
        &Rules::probe_of_no_way, &Rules::over_a_pocket, &Rules::rounding})
    if (auto found = (this->*rule)()) return found;
  return std::nullopt;
}

}  // namespace

std::optional<Excuse> excuse_of(const std::string& program, const Trace& own,
                                const Trace& reference, const std::string& difference) {
  return Rules(program, own, reference, difference).excuse();
}

}  // namespace aircut::test
