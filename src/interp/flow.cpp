// Labels of loops and branches live in the sub (or the main program) that they stand in; those of
// subs in the whole file. A problem is kept at its entry and told when the program gets there, as
// the control does it.
#include "interp/flow.h"

#include <algorithm>
#include <limits>
#include <tuple>
#include <utility>

#include "base/text.h"
#include "interp/dialect.h"
#include "interp/lexer.h"
#include "interp/parser.h"

namespace aircut::interp {
namespace {

constexpr std::size_t max_problems = 20'000;  // with a text of their own
constexpr std::size_t max_subs = 10'000;      // found without reading the program again

const char* text_of(Keyword keyword) {
  switch (keyword) {
    case Keyword::sub:
      return "sub";
    case Keyword::endsub:
      return "endsub";
    case Keyword::if_:
      return "if";
    case Keyword::elseif:
      return "elseif";
    case Keyword::else_:
      return "else";
    case Keyword::endif:
      return "endif";
    case Keyword::while_:
      return "while";
    case Keyword::endwhile:
      return "endwhile";
    case Keyword::do_:
      return "do";
    case Keyword::repeat:
      return "repeat";
    case Keyword::endrepeat:
      return "endrepeat";
    case Keyword::break_:
      return "break";
    case Keyword::continue_:
      return "continue";
    default:
      return "";
  }
}

Keyword end_of(Keyword keyword) {
  switch (keyword) {
    case Keyword::if_:
    case Keyword::elseif:
    case Keyword::else_:
      return Keyword::endif;
    case Keyword::while_:
      return Keyword::endwhile;
    case Keyword::do_:
      return Keyword::while_;
    case Keyword::repeat:
      return Keyword::endrepeat;
    default:
      return Keyword::endsub;
  }
}

// Whether a line may hold an O-word: `o` comes first, but for `/`, blanks and a line number.
bool starts_with_o(std::string_view line, bool& block_delete) {
  std::size_t at = 0;
  const auto skip = [&] {
    while (at < line.size() && (line[at] == ' ' || line[at] == '\t')) ++at;
  };
  skip();
  if (at < line.size() && line[at] == '/') {
    block_delete = true;
    ++at;
    skip();
  }
  if (at < line.size() && (line[at] | 32) == 'n') {
    ++at;
    while (at < line.size() && (line[at] == ' ' || line[at] == '\t' || line[at] == '.' ||
                                (line[at] >= '0' && line[at] <= '9')))
      ++at;
  }
  return at < line.size() && (line[at] | 32) == 'o';
}

bool is_percent(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos || line[first] != '%') return false;
  return line.find_first_not_of(" \t", first + 1) == std::string_view::npos;
}

const char* kind_of(FlowFault fault) {
  switch (fault) {
    case FlowFault::reused:
      return "label_reused";
    case FlowFault::nesting:
      return "flow_nesting";
    case FlowFault::syntax:
      return "flow_syntax";
    case FlowFault::limit:
      return "limit_reached";
    default:
      return "label_missing";
  }
}

// FNV-1a, 64 bits: two labels of the same hash are compared by their texts.
std::uint64_t hash_of(std::string_view label) {
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const char c : label) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return hash;
}

}  // namespace

FlowIndex::FlowIndex(const SourceText& source, std::uint64_t begin, bool block_delete,
                     bool stops_at_percent, Parameters& parameters, const CodeTable& table)
    : source_(source), parameters_(parameters), table_(table) {
  if (table.dialect().macro_b)
    read_macro_b(begin, block_delete, stops_at_percent);
  else
    read_o_words(begin, block_delete, stops_at_percent);
  const auto by_name = [](const SubName& a, const SubName& b) {
    return std::tie(a.fanuc, a.hash, a.entry) < std::tie(b.fanuc, b.hash, b.entry);
  };
  if (!names_.sort(by_name)) overfull_ = true;
}

bool FlowIndex::add(const FlowEntry& entry) {
  const bool fits = entries.size() < std::numeric_limits<std::int32_t>::max();
  if (!fits || !entries.push_back(entry)) overfull_ = true;
  return !overfull_;
}

void FlowIndex::read_o_words(std::uint64_t begin, bool block_delete, bool stops_at_percent) {
  const std::string_view text = source_.content();
  Reading reading(source_);
  Block block;
  std::uint64_t line_number = 0;
  bool first = true;
  while (begin < text.size() && !overfull_) {
    const LineExtent extent = find_line_end(text, begin, &reading);
    const std::string_view line = text.substr(begin, extent.end - begin);
    ++line_number;
    if (stops_at_percent && is_percent(line)) {
      if (!first) break;
      first = false;
    }
    bool deleted = false;
    if (starts_with_o(line, deleted) && !(deleted && block_delete)) {
      block.clear();
      // A line whose condition can't be read still is what its keyword says.
      parse_line(line, parameters_, table_, block);
      if (block.oword.keyword != Keyword::none && block.oword.keyword != Keyword::call) {
        FlowEntry entry;
        entry.begin = begin;
        entry.line = line_number;
        entry.keyword = block.oword.keyword;
        if (!add(entry)) break;
        connect(static_cast<int>(entries.size()) - 1, block.oword.label);
      }
    }
    begin = extent.next;
  }
  end_scope();
  if (sub_ >= 0)
    problem(sub_, FlowFault::missing, "this sub has no end; add o" + sub_label_ + " endsub");
  find_reused_labels();
}

FlowLine FlowIndex::line_of(int at) {
  const std::uint64_t begin = entries[static_cast<std::size_t>(at)].begin;
  const std::string_view text = source_.content();
  const LineExtent extent = find_line_end(text, begin);
  Block block;
  block.clear();
  parse_line(text.substr(begin, extent.end - begin), parameters_, table_, block);
  return {std::move(block.oword.label), block.oword.place, extent.next};
}

std::uint64_t FlowIndex::after(int at) {
  return find_line_end(source_.content(), entries[static_cast<std::size_t>(at)].begin).next;
}

FlowProblem FlowIndex::problem_of(int at) {
  const char* kind = kind_of(entries[static_cast<std::size_t>(at)].fault);
  const auto found = problems_.find(at);
  if (found != problems_.end()) return {kind, found->second};
  return {kind, "this O-word and the others of the program do not fit together (one of more than " +
                    std::to_string(max_problems) + " such problems)"};
}

// Programs mostly come from one entry to one of the next.
int FlowIndex::at(std::uint64_t begin) {
  constexpr std::size_t near = 16;
  std::size_t found = static_cast<std::size_t>(last_ + 1);
  const std::size_t end = std::min(entries.size(), found + near);
  const bool is_ahead = found < end && entries[found].begin <= begin;
  while (is_ahead && found < end && entries[found].begin < begin) ++found;
  if (!is_ahead || found == end)
    found = entries.lower_bound(
        begin, [](const FlowEntry& entry, std::uint64_t b) { return entry.begin < b; });
  if (found == entries.size() || entries[found].begin != begin) return -1;
  return last_ = static_cast<int>(found);
}

// ---- subs ------------------------------------------------------------------------------------

// The first sub of a name counts, and the first ones are found fastest.
void FlowIndex::name(int at, const std::string& label, bool fanuc) {
  if (!fanuc && subs_.size() < max_subs) {
    subs_.emplace(label, at);
    return;
  }
  if (!fanuc && subs_.contains(label)) return;
  if (!names_.push_back({hash_of(label), fanuc, at})) overfull_ = true;
}

bool FlowIndex::name_sub(int at, const std::string& label) {
  const auto [place, is_new] = subs_.insert_or_assign(label, at);
  if (is_new) ++computed_;
  return computed_ <= max_computed;
}

int FlowIndex::find_sub(std::string_view label) {
  const auto found = subs_.find(label);
  if (found != subs_.end()) return found->second;
  if (names_.empty()) return -1;
  const SubName wanted{hash_of(label), 0, 0};
  std::size_t i = names_.lower_bound(wanted, [](const SubName& a, const SubName& b) {
    return std::tie(a.fanuc, a.hash) < std::tie(b.fanuc, b.hash);
  });
  for (; i < names_.size(); ++i) {
    const SubName name = names_[i];
    if (name.fanuc != 0 || name.hash != wanted.hash) break;
    if (has_label(name.entry, label)) return name.entry;
  }
  return -1;
}

// In the order of the file.
template <class Fits>
int FlowIndex::first_fanuc(std::string_view label, std::int32_t from, const Fits& fits) {
  const SubName wanted{hash_of(label), 1, from};
  std::size_t i = names_.lower_bound(wanted, [](const SubName& a, const SubName& b) {
    return std::tie(a.fanuc, a.hash, a.entry) < std::tie(b.fanuc, b.hash, b.entry);
  });
  for (; i < names_.size(); ++i) {
    const SubName name = names_[i];
    if (name.fanuc != 1 || name.hash != wanted.hash) break;
    if (fits(entries[static_cast<std::size_t>(name.entry)]) && has_label(name.entry, label))
      return name.entry;
  }
  return -1;
}

int FlowIndex::find_fanuc(std::string_view label, std::uint64_t from) {
  const std::size_t first = entries.lower_bound(
      from, [](const FlowEntry& entry, std::uint64_t b) { return entry.begin < b; });
  return first_fanuc(label, static_cast<std::int32_t>(first),
                     [](const FlowEntry&) { return true; });
}

int FlowIndex::find_called_fanuc(std::string_view label) {
  return first_fanuc(label, 0, [](const FlowEntry& entry) { return entry.passed; });
}

// ---- what belongs together -------------------------------------------------------------------

void FlowIndex::problem(int at, FlowFault fault, std::string text) {
  FlowEntry& entry = entries[static_cast<std::size_t>(at)];
  if (entry.fault != FlowFault::none) return;
  entry.fault = fault;
  if (problems_.size() < max_problems) problems_.emplace(at, std::move(text));
}

void FlowIndex::connect(int at, const std::string& label) {
  FlowEntry& entry = entries[static_cast<std::size_t>(at)];
  entry.sub = sub_;
  switch (entry.keyword) {
    case Keyword::sub:
      if (sub_ >= 0)
        return problem(at, FlowFault::nesting,
                       "a sub can't be defined inside another one; close that with endsub before");
      end_scope();
      name(at, label, false);
      sub_ = at;
      sub_label_ = label;
      return;
    case Keyword::endsub:
      if (sub_ < 0 || sub_label_ != label)
        return problem(at, FlowFault::missing, "there is no o" + label + " sub for this endsub");
      end_scope();
      entry.partner = sub_;
      entries[static_cast<std::size_t>(sub_)].partner = at;
      sub_ = -1;
      return;
    case Keyword::fanuc_sub:
      if (sub_ < 0) ++scope_;
      return name(at, label, true);
    case Keyword::if_:
    case Keyword::do_:
    case Keyword::repeat:
      return open(at, label);
    case Keyword::while_: {
      const bool closes = std::any_of(open_.begin(), open_.end(), [&](const Open& other) {
        return other.keyword == Keyword::do_ && other.label == label;
      });
      return closes ? close(at, label) : open(at, label);
    }
    case Keyword::endif:
    case Keyword::endwhile:
    case Keyword::endrepeat:
      return close(at, label);
    case Keyword::elseif:
    case Keyword::else_:
      return branch(at, label);
    case Keyword::break_:
    case Keyword::continue_:
      return leave_loop(at, label);
    default:
      return;
  }
}

// Tells the construct, and all branches of an if, that it has no end.
void FlowIndex::leave_open(int at, const std::string& text) {
  while (at >= 0) {
    FlowEntry& entry = entries[static_cast<std::size_t>(at)];
    const bool is_branch = entry.keyword == Keyword::elseif || entry.keyword == Keyword::else_;
    const int before = is_branch ? entry.partner : -1;
    problem(at, FlowFault::missing, text);
    entry.partner = -1;
    entry.next = -1;
    at = before;
  }
}

// What is still open here has no end.
void FlowIndex::end_scope() {
  for (const Open& open : open_) {
    if (open.keyword == Keyword::while_do) {
      problem(open.at, FlowFault::missing,
              "DO" + open.label + " has no end in its program; add END" + open.label);
      continue;
    }
    leave_open(open.at, std::string("this ") + text_of(open.keyword) + " has no end; add o" +
                            open.label + " " + text_of(end_of(open.keyword)));
  }
  open_.clear();
  ++scope_;
}

void FlowIndex::open(int at, const std::string& label) {
  if (open_.size() >= max_open)
    return problem(at, FlowFault::limit,
                   "more than 1000 loops and branches inside each other; use subs");
  if (!labels_.push_back({hash_of(label), scope_, at})) overfull_ = true;
  open_.push_back({at, entries[static_cast<std::size_t>(at)].keyword, label});
}

// A label may open one block of its scope. This comes last, but is what the control tells first.
void FlowIndex::find_reused_labels() {
  const auto before = [](const LabelUse& a, const LabelUse& b) {
    return std::tie(a.scope, a.hash, a.entry) < std::tie(b.scope, b.hash, b.entry);
  };
  if (!labels_.sort(before)) overfull_ = true;
  std::vector<std::string> seen;  // of one hash: one, unless two labels share it
  for (std::size_t i = 1; i < labels_.size() && !overfull_; ++i) {
    const LabelUse last = labels_[i - 1], use = labels_[i];
    if (last.scope != use.scope || last.hash != use.hash) {
      seen.clear();
      continue;
    }
    if (seen.empty()) seen.push_back(line_of(last.entry).label);
    const std::string label = line_of(use.entry).label;
    if (std::find(seen.begin(), seen.end(), label) == seen.end()) {
      seen.push_back(label);
      continue;
    }
    entries[static_cast<std::size_t>(use.entry)].fault = FlowFault::none;
    problems_.erase(use.entry);
    problem(
        use.entry, FlowFault::reused,
        "the label o" + label + " has been used here before; give every block a label of its own");
  }
  labels_ = {};
}

void FlowIndex::close(int at, const std::string& label) {
  FlowEntry& entry = entries[static_cast<std::size_t>(at)];
  const auto fits = [&](const Open& other) {
    return end_of(other.keyword) == entry.keyword && other.label == label;
  };
  if (std::none_of(open_.begin(), open_.end(), fits))
    return problem(at, FlowFault::missing,
                   std::string("there is nothing open that o") + label + " " +
                       text_of(entry.keyword) + " could close; check the label");
  while (!fits(open_.back())) {
    const Open& top = open_.back();
    leave_open(top.at, std::string("this ") + text_of(top.keyword) + " is not closed before o" +
                           label + " " + text_of(entry.keyword) + "; add o" + top.label + " " +
                           text_of(end_of(top.keyword)));
    open_.pop_back();
  }
  const int top = open_.back().at;
  open_.pop_back();
  entry.partner = top;
  FlowEntry& opener = entries[static_cast<std::size_t>(top)];
  const bool is_branch = opener.keyword == Keyword::elseif || opener.keyword == Keyword::else_;
  if (is_branch || opener.keyword == Keyword::if_) opener.next = at;
  if (!is_branch) {
    opener.partner = at;
    return;
  }
  // Each branch has known the one before it; now all know the end, through which they are left.
  for (int branch = top; branch >= 0;) {
    FlowEntry& one = entries[static_cast<std::size_t>(branch)];
    branch = one.keyword == Keyword::if_ ? -1 : one.partner;
    one.partner = at;
  }
}

// elseif and else take the place of the branch before them on the stack of open constructs;
// `partner` points back to that branch until the endif is found.
void FlowIndex::branch(int at, const std::string& label) {
  FlowEntry& entry = entries[static_cast<std::size_t>(at)];
  if (!open_.empty()) {
    Open& before = open_.back();
    const bool is_branch = before.keyword == Keyword::if_ || before.keyword == Keyword::elseif;
    if (is_branch && before.label == label) {
      entries[static_cast<std::size_t>(before.at)].next = at;
      entry.partner = before.at;
      before.at = at;
      before.keyword = entry.keyword;
      return;
    }
  }
  problem(at, FlowFault::missing,
          std::string("there is no open if with the label o") + label + " for this " +
              text_of(entry.keyword));
}

void FlowIndex::leave_loop(int at, const std::string& label) {
  FlowEntry& entry = entries[static_cast<std::size_t>(at)];
  const auto found = std::find_if(open_.rbegin(), open_.rend(),
                                  [&](const Open& other) { return other.label == label; });
  if (found == open_.rend())
    return problem(
        at, FlowFault::missing,
        std::string(text_of(entry.keyword)) + " needs the label of a loop that it is in");
  if (found->keyword == Keyword::while_ || found->keyword == Keyword::do_)
    entry.partner = found->at;
  else
    problem(at, FlowFault::syntax,
            std::string(text_of(entry.keyword)) + " works in while and do loops only, not in " +
                text_of(found->keyword));
}

}  // namespace aircut::interp
