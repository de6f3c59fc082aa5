// The index of a file of macro B: program headers, N blocks, and which END belongs to which DO.
// One pass over the lines; only those that may hold a header or a loop are parsed. Loops belong to
// their program and nest without crossing; a problem is told when the program gets there.
#include <algorithm>
#include <tuple>
#include <utility>

#include "interp/flow.h"
#include "interp/lexer.h"
#include "interp/parser.h"

namespace aircut::interp {
namespace {

bool is_digit_char(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\t'; }
char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }
bool is_letter_char(char c) { return lower(c) >= 'a' && lower(c) <= 'z'; }

/// What a line looks like without parsing it.
struct Glance {
  std::int64_t number = -1;  ///< of the N word
  char first = 0;            ///< the first letter (lower case) behind `/` and N
  bool block_delete = false;
  bool percent = false;
};

// Digits with blanks between them, as the control reads them.
std::int64_t digits_at(std::string_view line, std::size_t& at) {
  std::int64_t number = -1;
  for (; at < line.size() && (is_digit_char(line[at]) || is_blank(line[at])); ++at)
    if (is_digit_char(line[at]) && number < 1'000'000'000)
      number = std::max<std::int64_t>(number, 0) * 10 + (line[at] - '0');
  return number;
}

Glance glance(std::string_view line) {
  Glance seen;
  char before = 0;
  for (std::size_t at = 0; at < line.size();) {
    const char c = lower(line[at]);
    if (is_blank(c)) {
      ++at;
      continue;
    }
    if (c == '(') {
      at = std::min(line.find(')', at), line.size() - 1) + 1;
      continue;
    }
    if (c == ';') break;
    if (before == 0 && c == '%') {
      seen.percent = true;
      break;
    }
    if (before == 0 && c == '/') {
      seen.block_delete = true;
      ++at;
      before = '/';
      if (at < line.size() && is_digit_char(line[at])) ++at;
      continue;
    }
    if (c == 'n' && !is_letter_char(before) && seen.number < 0) {
      std::size_t behind = at + 1;
      const std::int64_t number = digits_at(line, behind);
      if (number >= 0) {
        seen.number = number;
        at = behind;
        before = '0';
        continue;
      }
    }
    if (seen.first == 0) seen.first = c;
    before = c;
    ++at;
  }
  return seen;
}

bool may_be_entry(char first) {
  return first == 'o' || first == ':' || first == 'w' || first == 'd' || first == 'e';
}

auto key(const NumberedBlock& block) {
  return std::tuple(block.program, block.number, block.place.begin);
}

}  // namespace

void FlowIndex::read_macro_b(const SourceText& source, std::uint64_t begin, bool block_delete,
                             bool stops_at_percent, Parameters& parameters,
                             const CodeTable& table) {
  Block block;
  const std::string_view text = source.content();
  Reading reading(source);
  std::uint64_t line_number = 0;
  bool first = true;
  while (begin < text.size()) {
    if (entries.size() >= max_entries || numbered_.size() >= max_numbered) {
      overfull_ = true;
      break;
    }
    const LineExtent extent = find_line_end(text, begin, &reading);
    const std::string_view line = text.substr(begin, extent.end - begin);
    const std::uint64_t at = std::exchange(begin, extent.next);
    ++line_number;
    const Glance seen = glance(line);
    if (stops_at_percent && seen.percent && !std::exchange(first, false)) break;
    if (seen.block_delete && block_delete) continue;
    FlowEntry entry;
    if (may_be_entry(seen.first)) {
      block.clear();
      parse_line(line, parameters, table, block);
      entry.keyword = block.oword.keyword;
    }
    const bool is_header = entry.keyword == Keyword::program;
    if (seen.number >= 0 && !is_header)
      numbered_.push_back({static_cast<std::int32_t>(std::min<std::int64_t>(seen.number, 1 << 30)),
                           sub_,
                           open_.empty() ? -1 : open_.back(),
                           {at, extent.next, line_number}});
    if (!is_header && entry.keyword != Keyword::while_do && entry.keyword != Keyword::end_)
      continue;
    entry.begin = at;
    entry.after = extent.next;
    entry.line = line_number;
    entry.label = block.oword.label;
    entry.place = block.oword.place;
    entries.push_back(std::move(entry));
    connect_macro_b(static_cast<int>(entries.size()) - 1);
  }
  end_scope();
  std::sort(numbered_.begin(), numbered_.end(),
            [](const NumberedBlock& a, const NumberedBlock& b) { return key(a) < key(b); });
}

void FlowIndex::connect_macro_b(int at) {
  FlowEntry& entry = entries[static_cast<std::size_t>(at)];
  if (entry.keyword == Keyword::program) {
    end_scope();
    sub_ = at;
    entry.sub = at;
    subs_.emplace(entry.label, at);
    return;
  }
  entry.sub = sub_;
  if (entry.keyword == Keyword::end_) return close_loop(at);
  const bool open = std::any_of(open_.begin(), open_.end(), [&](int other) {
    return entries[static_cast<std::size_t>(other)].label == entry.label;
  });
  if (open)
    problem(at, "flow_nesting",
            "DO" + entry.label + " inside DO" + entry.label +
                "; loops inside each other need different numbers");
  entry.next = open_.empty() ? -1 : open_.back();
  open_.push_back(at);
}

void FlowIndex::close_loop(int at) {
  FlowEntry& end = entries[static_cast<std::size_t>(at)];
  const auto fits = [&](int other) {
    return entries[static_cast<std::size_t>(other)].label == end.label;
  };
  if (std::none_of(open_.begin(), open_.end(), fits))
    return problem(at, "label_missing", "there is no DO" + end.label + " before this END");
  while (!fits(open_.back())) {
    const FlowEntry& crossed = entries[static_cast<std::size_t>(open_.back())];
    problem(open_.back(), "flow_nesting",
            "DO" + crossed.label + " is not closed before END" + end.label +
                "; loops can't cross each other");
    open_.pop_back();
  }
  end.partner = open_.back();
  entries[static_cast<std::size_t>(open_.back())].partner = at;
  open_.pop_back();
}

int FlowIndex::program_at(std::uint64_t begin) const {
  const auto behind =
      std::upper_bound(entries.begin(), entries.end(), begin,
                       [](std::uint64_t b, const FlowEntry& entry) { return b < entry.begin; });
  return behind == entries.begin() ? -1 : std::prev(behind)->sub;
}

const NumberedBlock* FlowIndex::find_block(std::int64_t number, std::uint64_t from) const {
  if (number < 0 || number > (1 << 30)) return nullptr;
  const int program = program_at(from);
  const auto wanted = static_cast<std::int32_t>(number);
  const auto at = [&](std::uint64_t begin) {
    const auto found = std::lower_bound(
        numbered_.begin(), numbered_.end(), std::tuple(program, wanted, begin),
        [](const NumberedBlock& block, const auto& value) { return key(block) < value; });
    const bool fits =
        found != numbered_.end() && found->program == program && found->number == wanted;
    return fits ? &*found : nullptr;
  };
  if (const NumberedBlock* behind = at(from + 1)) return behind;
  return at(0);
}

}  // namespace aircut::interp
