// Labels of loops and branches live in the sub (or the main program) that they stand in; those of
// subs in the whole file. A problem is kept at its entry and told when the program gets there, as
// the control does it.
#include "interp/flow.h"

#include <algorithm>

#include "base/text.h"
#include "interp/dialect.h"
#include "interp/lexer.h"
#include "interp/parser.h"

namespace aircut::interp {
namespace {

constexpr std::size_t max_open = 1000;  // the searches below go through all that is open

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

}  // namespace

FlowIndex::FlowIndex(const SourceText& source, std::uint64_t begin, bool block_delete,
                     bool stops_at_percent, Parameters& parameters, const CodeTable& table) {
  if (table.dialect().macro_b) {
    read_macro_b(source, begin, block_delete, stops_at_percent, parameters, table);
    return;
  }
  const std::string_view text = source.content();
  Reading reading(source);
  Block block;
  std::uint64_t line_number = 0;
  bool first = true;
  while (begin < text.size()) {
    if (entries.size() >= max_entries) {
      overfull_ = true;
      break;
    }
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
      parse_line(line, parameters, table, block);
      if (block.oword.keyword != Keyword::none && block.oword.keyword != Keyword::call) {
        FlowEntry entry;
        entry.begin = begin;
        entry.after = extent.next;
        entry.line = line_number;
        entry.keyword = block.oword.keyword;
        entry.label = block.oword.label;
        entry.place = block.oword.place;
        entries.push_back(std::move(entry));
      }
    }
    begin = extent.next;
  }
  connect();
}

int FlowIndex::at(std::uint64_t begin) const {
  const auto found =
      std::lower_bound(entries.begin(), entries.end(), begin,
                       [](const FlowEntry& entry, std::uint64_t b) { return entry.begin < b; });
  if (found == entries.end() || found->begin != begin) return -1;
  return static_cast<int>(found - entries.begin());
}

int FlowIndex::find_sub(std::string_view label) const {
  const auto found = subs_.find(label);
  return found == subs_.end() ? -1 : found->second;
}

int FlowIndex::find_fanuc(std::string_view label, std::uint64_t after) const {
  int found = -1;
  for (std::size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].keyword != Keyword::fanuc_sub || entries[i].label != label) continue;
    found = static_cast<int>(i);
    if (entries[i].begin > after) return found;
  }
  return found;
}

void FlowIndex::problem(int at, const char* kind, std::string text) {
  FlowEntry& entry = entries[static_cast<std::size_t>(at)];
  if (entry.problem_kind) return;
  entry.problem_kind = kind;
  entry.problem = std::move(text);
}

void FlowIndex::connect() {
  for (int i = 0; i < static_cast<int>(entries.size()); ++i) {
    FlowEntry& entry = entries[static_cast<std::size_t>(i)];
    entry.sub = sub_;
    switch (entry.keyword) {
      case Keyword::sub:
        if (sub_ >= 0) {
          problem(i, "flow_nesting",
                  "a sub can't be defined inside another one; close that with endsub before");
          break;
        }
        end_scope();
        subs_.emplace(entry.label, i);  // the first one counts
        sub_ = i;
        break;
      case Keyword::endsub:
        if (sub_ < 0 || entries[static_cast<std::size_t>(sub_)].label != entry.label) {
          problem(i, "label_missing", "there is no o" + entry.label + " sub for this endsub");
          break;
        }
        end_scope();
        entry.partner = sub_;
        entries[static_cast<std::size_t>(sub_)].partner = i;
        sub_ = -1;
        break;
      case Keyword::if_:
      case Keyword::do_:
      case Keyword::repeat:
        open(i);
        break;
      case Keyword::while_: {
        const bool closes = std::any_of(open_.begin(), open_.end(), [&](int other) {
          const FlowEntry& o = entries[static_cast<std::size_t>(other)];
          return o.keyword == Keyword::do_ && o.label == entry.label;
        });
        if (closes)
          close(i);
        else
          open(i);
        break;
      }
      case Keyword::endif:
      case Keyword::endwhile:
      case Keyword::endrepeat:
        close(i);
        break;
      case Keyword::elseif:
      case Keyword::else_:
        branch(i);
        break;
      case Keyword::break_:
      case Keyword::continue_:
        leave_loop(i);
        break;
      default:
        break;
    }
  }
  end_scope();
  if (sub_ >= 0)
    problem(
        sub_, "label_missing",
        "this sub has no end; add o" + entries[static_cast<std::size_t>(sub_)].label + " endsub");
}

// Tells the construct, and all branches of an if, that it has no end.
void FlowIndex::leave_open(int at, const std::string& text) {
  while (at >= 0) {
    FlowEntry& entry = entries[static_cast<std::size_t>(at)];
    const bool is_branch = entry.keyword == Keyword::elseif || entry.keyword == Keyword::else_;
    const int before = is_branch ? entry.partner : -1;
    problem(at, "label_missing", text);
    entry.partner = -1;
    entry.next = -1;
    at = before;
  }
}

// What is still open here has no end.
void FlowIndex::end_scope() {
  for (const int at : open_) {
    const FlowEntry& entry = entries[static_cast<std::size_t>(at)];
    if (entry.keyword == Keyword::while_do) {
      problem(at, "label_missing",
              "DO" + entry.label + " has no end in its program; add END" + entry.label);
      continue;
    }
    leave_open(at, std::string("this ") + text_of(entry.keyword) + " has no end; add o" +
                       entry.label + " " + text_of(end_of(entry.keyword)));
  }
  open_.clear();
  used_.clear();
}

void FlowIndex::open(int at) {
  const FlowEntry& entry = entries[static_cast<std::size_t>(at)];
  if (open_.size() >= max_open)
    return problem(at, "limit_reached",
                   "more than 1000 loops and branches inside each other; use subs");
  if (!used_.insert(entry.label).second)
    problem(at, "label_reused",
            "the label o" + entry.label +
                " has been used here before; give every block a label of its own");
  open_.push_back(at);
}

void FlowIndex::close(int at) {
  FlowEntry& entry = entries[static_cast<std::size_t>(at)];
  while (!open_.empty()) {
    const int top = open_.back();
    FlowEntry& opener = entries[static_cast<std::size_t>(top)];
    const bool fits = end_of(opener.keyword) == entry.keyword && opener.label == entry.label;
    const bool fits_deeper = std::any_of(open_.begin(), open_.end(), [&](int other) {
      const FlowEntry& o = entries[static_cast<std::size_t>(other)];
      return end_of(o.keyword) == entry.keyword && o.label == entry.label;
    });
    if (!fits && !fits_deeper) break;
    open_.pop_back();
    if (!fits) {
      leave_open(top, std::string("this ") + text_of(opener.keyword) + " is not closed before o" +
                          entry.label + " " + text_of(entry.keyword) + "; add o" + opener.label +
                          " " + text_of(end_of(opener.keyword)));
      continue;
    }
    entry.partner = top;
    if (opener.keyword == Keyword::elseif || opener.keyword == Keyword::else_) {
      opener.next = at;
      // All branches know the end: they are left through it.
      for (int branch = opener.partner; branch >= 0;) {
        FlowEntry& first = entries[static_cast<std::size_t>(branch)];
        if (first.keyword == Keyword::if_) {
          for (int b = branch; b != at; b = entries[static_cast<std::size_t>(b)].next)
            entries[static_cast<std::size_t>(b)].partner = at;
          break;
        }
        branch = first.partner;
      }
    } else {
      opener.partner = at;
      if (opener.keyword == Keyword::if_) opener.next = at;
    }
    return;
  }
  problem(at, "label_missing",
          std::string("there is nothing open that o") + entry.label + " " + text_of(entry.keyword) +
              " could close; check the label");
}

// elseif and else take the place of the branch before them on the stack of open constructs;
// `partner` points back to that branch until the endif is found.
void FlowIndex::branch(int at) {
  FlowEntry& entry = entries[static_cast<std::size_t>(at)];
  if (!open_.empty()) {
    const int top = open_.back();
    FlowEntry& before = entries[static_cast<std::size_t>(top)];
    const bool is_branch = before.keyword == Keyword::if_ || before.keyword == Keyword::elseif;
    if (is_branch && before.label == entry.label) {
      before.next = at;
      entry.partner = top;
      open_.back() = at;
      return;
    }
  }
  problem(at, "label_missing",
          std::string("there is no open if with the label o") + entry.label + " for this " +
              text_of(entry.keyword));
}

void FlowIndex::leave_loop(int at) {
  FlowEntry& entry = entries[static_cast<std::size_t>(at)];
  for (auto open = open_.rbegin(); open != open_.rend(); ++open) {
    const FlowEntry& other = entries[static_cast<std::size_t>(*open)];
    if (other.label != entry.label) continue;
    if (other.keyword == Keyword::while_ || other.keyword == Keyword::do_)
      entry.partner = *open;
    else
      problem(at, "flow_syntax",
              std::string(text_of(entry.keyword)) + " works in while and do loops only, not in " +
                  text_of(other.keyword));
    return;
  }
  problem(at, "label_missing",
          std::string(text_of(entry.keyword)) + " needs the label of a loop that it is in");
}

}  // namespace aircut::interp
