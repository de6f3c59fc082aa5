// Grammar (no blanks; `-` separates couples, O is the bed):
//
//   machine = chain { ";" chain }
//   chain   = [ "Wp-" | "T-" ] [ side "-" ] "O" [ "-" side ] [ "-T" | "-Wp" ]
//   side    = couple { "-" couple }  |  "{" side { "|" side } "}"
//   couple  = ("R"|"T") "(" element [ ":" axis ] ")"
//
// Left of O the couple that is farthest from the bed comes first, right of it the nearest one. The
// workpiece is on the side with a workpiece spindle (MS, SS) or a rotary table (RT), unless Wp or T
// at an end say otherwise; without any of them it is on the left. A parse notes where each couple
// stands, so that what is wrong with the machine as a whole has a column, too.
#include "machine/formula/formula.h"

#include <algorithm>
#include <array>
#include <map>

namespace aircut::machine {

namespace {

struct Element {
  std::string_view letters;
  std::string_view axis;  ///< unless the formula says another one; empty: indexing
  std::string_view is;
};
constexpr std::array<Element, 13> elements = {{{"MS", "C", "main spindle"},
                                               {"SS", "C2", "secondary spindle"},
                                               {"LS", "Z", "longitudinal slide"},
                                               {"TS", "X", "transversal slide"},
                                               {"VS", "Z", "vertical slide"},
                                               {"RS", "", "rotary steady"},
                                               {"RH", "", "revolver head"},
                                               {"MTS", "X", "multi-tool holder"},
                                               {"HA", "B", "swivelling head"},
                                               {"RT", "C", "rotary table"},
                                               {"HD", "B", "milling head"},
                                               {"TL", "W", "tailstock"},
                                               {"PS", "Y", "cross slide"}}};

const Element* element_of(std::string_view letters) {
  for (const Element& e : elements)
    if (e.letters == letters) return &e;
  return nullptr;
}

bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

bool holds_work(std::string_view kind) { return kind == "MS" || kind == "SS" || kind == "RT"; }

/// A couple with what the parser still needs to know of it.
struct Placed {
  FormulaCouple couple;
  std::size_t column;
  bool own_axis;  ///< the formula says the axis
};
struct Side {
  std::vector<std::vector<Placed>> branches;
  std::size_t column = 1;
  bool braces = false;
  std::string marker;  ///< Wp, T or empty

  const Placed* work_holder() const {
    for (const auto& branch : branches)
      for (const Placed& p : branch)
        if (holds_work(p.couple.kind())) return &p;
    return nullptr;
  }
};
struct PlacedChain {
  std::vector<Placed> work;
  std::vector<std::vector<Placed>> tools;
};

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  tl::expected<Formula, FormulaError> run() {
    constexpr std::size_t longest = 4096;
    if (text_.size() > longest) {
      at_ = longest;
      fail("a formula has at most 4096 characters");
    }
    std::vector<PlacedChain> chains;
    while (good()) {
      chains.push_back(chain());
      if (!good() || at_ == text_.size()) break;
      expect(';', "';' and another chain, or the end of the formula");
    }
    if (good()) name_axes(chains);
    if (error_) return unexpected(*error_);
    Formula formula;
    const auto plain = [](const std::vector<Placed>& placed) {
      FormulaBranch branch;
      for (const Placed& p : placed) branch.push_back(p.couple);
      return branch;
    };
    for (const PlacedChain& c : chains) {
      FormulaChain out{plain(c.work), {}};
      for (const auto& tool : c.tools) out.tools.push_back(plain(tool));
      formula.chains.push_back(std::move(out));
    }
    return formula;
  }

 private:
  bool good() const { return !error_; }
  void fail(std::string message, std::optional<std::size_t> at = {}) {
    if (!error_) error_ = FormulaError{at.value_or(at_ + 1), std::move(message)};
  }
  bool next_is(std::string_view word) const { return text_.substr(at_).starts_with(word); }
  bool take(std::string_view word) {
    if (!good() || !next_is(word)) return false;
    at_ += word.size();
    return true;
  }
  std::string here() const {
    return at_ < text_.size() ? "'" + printable(text_.substr(at_, 1)) + "' stands here"
                              : "the formula ends here";
  }
  void expect(char c, const std::string& what) {
    if (!take(std::string_view(&c, 1))) fail("expected " + what + "; " + here());
  }

  // O alone, not the O of a longer word.
  bool at_bed() const {
    if (!next_is("O")) return false;
    return at_ + 1 == text_.size() || text_[at_ + 1] == '-' || text_[at_ + 1] == ';';
  }
  bool take_marker(Side& side) {
    for (const char* marker : {"Wp", "T"}) {
      const std::string_view rest =
          text_.substr(std::min(at_ + std::string_view(marker).size(), text_.size()));
      if (!next_is(marker) || !(rest.empty() || rest[0] == '-' || rest[0] == ';')) continue;
      at_ += std::string_view(marker).size();
      side.marker = marker;
      return true;
    }
    return false;
  }

  PlacedChain chain() {
    const std::size_t begin = at_;
    Side left, right;
    left.column = at_ + 1;
    if (take_marker(left)) expect('-', "'-' behind '" + left.marker + "'");
    if (good() && !at_bed()) {
      read_side(left);
      if (good() && !next_is("-")) fail("expected '-' and the bed O, or another couple; " + here());
      take("-");
    }
    if (good() && !at_bed()) fail("expected the bed O; " + here());
    take("O");
    right.column = at_ + 1;
    if (take("-") && !take_marker(right)) {
      read_side(right);
      if (take("-") && !take_marker(right))
        fail(at_bed() ? "the bed O stands twice in a chain; ';' separates chains"
                      : "expected a couple, 'Wp' or 'T'; " + here());
    }
    for (auto& branch : left.branches) std::reverse(branch.begin(), branch.end());
    return good() ? sides(left, right, begin + 1) : PlacedChain{};
  }

  void read_side(Side& side) {
    if (!take("{")) {
      side.branches.push_back(branch());
      return;
    }
    side.braces = true;
    do side.branches.push_back(branch());
    while (take("|"));
    expect('}', "'|' and another branch, or '}'");
  }

  std::vector<Placed> branch() {
    std::vector<Placed> couples = {couple()};
    // Behind a `-` comes another couple, or the bed or a marker, which are left to the caller.
    while (good() && next_is("-") && at_ + 2 < text_.size() && text_[at_ + 2] == '(') {
      take("-");
      couples.push_back(couple());
    }
    return couples;
  }

  Placed couple() {
    Placed placed{{}, at_ + 1, false};
    if (!good()) return placed;
    if (!next_is("R(") && !next_is("T(")) {
      fail("expected a couple, R(…) that turns or T(…) that slides; " + here());
      return placed;
    }
    placed.couple.rotary = next_is("R");
    at_ += 2;
    const std::size_t begin = at_;
    while (at_ < text_.size() && is_upper(text_[at_])) ++at_;
    const std::string letters(text_.substr(begin, at_ - begin));
    while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
    placed.couple.element = text_.substr(begin, at_ - begin);
    const Element* element = element_of(letters);
    if (!element) return unknown_element(placed, letters, begin);
    placed.couple.axis = element->axis;
    if (take(":")) read_axis(placed);
    expect(')', "')' behind the element, or ':' and its axis");
    return placed;
  }

  Placed unknown_element(const Placed& placed, const std::string& letters, std::size_t begin) {
    std::vector<std::string> words;
    std::string known;
    for (const Element& e : elements) {
      words.emplace_back(e.letters);
      known += (known.empty() ? "" : ", ") + std::string(e.letters);
    }
    fail("there is no element '" + letters + "'." + did_you_mean(letters, words) + " There are " +
             known,
         begin + 1);
    return placed;
  }

  void read_axis(Placed& placed) {
    const std::size_t begin = at_;
    const std::string_view letters = placed.couple.rotary ? "ABCS" : "XYZUVW";
    if (at_ < text_.size() && letters.find(text_[at_]) != letters.npos) {
      ++at_;
      while (at_ < text_.size() && is_digit(text_[at_])) ++at_;
      placed.couple.axis = text_.substr(begin, at_ - begin);
      placed.own_axis = true;
      return;
    }
    fail(placed.couple.rotary ? "a turning couple has an axis A, B or C, or S for a spindle that "
                                "turns by speed; " +
                                    here()
                              : "a sliding couple has an axis X, Y, Z, U, V or W; " + here());
  }

  // Which side is the workpiece's.
  PlacedChain sides(Side& left, Side& right, std::size_t column) {
    const Placed *a = left.work_holder(), *b = right.work_holder();
    const bool said = !left.marker.empty() || !right.marker.empty();
    if (!left.marker.empty() && left.marker == right.marker)
      fail("both ends are marked '" + left.marker +
               "'; one is the workpiece's (Wp), one the tool's (T)",
           column);
    if (a && b && !said)
      fail("both sides of the bed hold a workpiece (" + a->couple.element + " and " +
               b->couple.element + "); mark the workpiece's end with Wp, or write two chains",
           b->column);
    const bool work_left = left.marker == "Wp" || right.marker == "T"   ? true
                           : left.marker == "T" || right.marker == "Wp" ? false
                                                                        : !b || a;
    if (left.branches.empty() && right.branches.empty())
      fail("a chain needs a couple on one side of the bed at least", column);
    Side& work = work_left ? left : right;
    Side& tool = work_left ? right : left;
    if (work.braces && work.branches.size() > 1)
      fail("braces hold parallel tool branches; the workpiece has one branch", work.column);
    PlacedChain out;
    if (!work.branches.empty()) out.work = std::move(work.branches.front());
    out.tools = std::move(tool.branches);
    if (out.tools.empty()) out.tools.emplace_back();
    return out;
  }

  // An axis that the formula does not name gets the element's number, or the next one that is free
  // when its letter is used more than once. Axes that can't belong to their couple end here, too.
  void name_axes(std::vector<PlacedChain>& chains) {
    std::vector<Placed*> all;
    for (PlacedChain& c : chains) {
      for (Placed& p : c.work) all.push_back(&p);
      for (auto& tool : c.tools)
        for (Placed& p : tool) all.push_back(&p);
    }
    std::vector<std::string> used;
    const auto is_used = [&](const std::string& name) {
      return std::find(used.begin(), used.end(), name) != used.end();
    };
    for (const Placed* p : all) {
      if (!p->own_axis || p->couple.is_spindle()) continue;
      if (is_used(p->couple.axis))
        fail("the axis " + p->couple.axis + " stands twice; give each its own number", p->column);
      used.push_back(p->couple.axis);
    }
    std::map<char, int> unnamed;
    for (const Placed* p : all)
      if (!p->own_axis && !p->couple.axis.empty()) ++unnamed[p->couple.axis[0]];
    for (Placed* p : all) {
      FormulaCouple& couple = p->couple;
      if (p->own_axis || couple.axis.empty()) continue;
      const bool turns = couple.axis[0] >= 'A' && couple.axis[0] <= 'C';
      if (turns != couple.rotary) {
        fail("the element " + couple.element + (turns ? " turns" : " slides") +
                 " unless its axis is given; this couple " + (couple.rotary ? "turns" : "slides"),
             p->column);
        return;
      }
      const std::string letter = couple.axis.substr(0, 1);
      const std::string number = couple.element.substr(couple.kind().size());
      if (!number.empty()) couple.axis = letter + number;
      int next = 1;
      if (unnamed[couple.axis[0]] > 1 && number.empty()) couple.axis = letter + "1";
      while (is_used(couple.axis)) couple.axis = letter + std::to_string(next++);
      used.push_back(couple.axis);
    }
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::optional<FormulaError> error_;
};

std::string text_of(const FormulaCouple& couple) {
  return std::string(couple.rotary ? "R(" : "T(") + couple.element +
         (couple.axis.empty() ? "" : ":" + couple.axis) + ")";
}

std::string text_of(const FormulaBranch& branch, bool outwards) {
  FormulaBranch couples = branch;
  if (!outwards) std::reverse(couples.begin(), couples.end());
  std::string text;
  for (const FormulaCouple& c : couples) text += (text.empty() ? "" : "-") + text_of(c);
  return text;
}

std::string text_of(const FormulaChain& chain) {
  const auto holds = [](const FormulaBranch& branch) {
    return std::any_of(branch.begin(), branch.end(),
                       [](const FormulaCouple& c) { return holds_work(c.kind()); });
  };
  std::string right;
  if (chain.tools.size() > 1) {
    for (const FormulaBranch& tool : chain.tools)
      right += (right.empty() ? "{" : "|") + text_of(tool, true);
    right += "}";
  } else if (!chain.tools.empty()) {
    right = text_of(chain.tools.front(), true);
  }
  const std::string left = text_of(chain.work, false);
  // Where the elements alone would be read the other way, Wp tells the workpiece's end.
  const bool plain = !std::any_of(chain.tools.begin(), chain.tools.end(), holds);
  return (plain ? "" : "Wp-") + left + (left.empty() ? "O" : "-O") +
         (right.empty() ? "" : "-" + right);
}

}  // namespace

std::string_view FormulaCouple::kind() const {
  return std::string_view(element).substr(0, element.find_first_of("0123456789"));
}

tl::expected<Formula, FormulaError> parse_formula(std::string_view text) {
  return Parser(text).run();
}

std::string text_of(const Formula& formula) {
  std::string text;
  for (const FormulaChain& chain : formula.chains)
    text += (text.empty() ? "" : ";") + text_of(chain);
  return text;
}

}  // namespace aircut::machine
