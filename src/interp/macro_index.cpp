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

}  // namespace

void FlowIndex::read_macro_b(std::uint64_t begin, bool block_delete, bool stops_at_percent) {
  Block block;
  const std::string_view text = source_.content();
  Reading reading(source_);
  std::uint64_t line_number = 0;
  bool first = true;
  while (begin < text.size() && !overfull_) {
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
      parse_line(line, parameters_, table_, block);
      entry.keyword = block.oword.keyword;
    }
    const bool is_header = entry.keyword == Keyword::program;
    if (seen.number >= 0 && !is_header) {
      const auto number = static_cast<std::int32_t>(std::min<std::int64_t>(seen.number, 1 << 30));
      if (!numbered_.push_back(
              {at, line_number, number, sub_, open_.empty() ? -1 : open_.back().at}))
        overfull_ = true;
    }
    if (!is_header && entry.keyword != Keyword::while_do && entry.keyword != Keyword::end_)
      continue;
    entry.begin = at;
    entry.line = line_number;
    if (!add(entry)) break;
    connect_macro_b(static_cast<int>(entries.size()) - 1, block.oword.label);
  }
  end_scope();
  const bool sorted = numbered_.sort([](const Numbered& a, const Numbered& b) {
    return std::tie(a.program, a.number, a.begin) < std::tie(b.program, b.number, b.begin);
  });
  if (!sorted) overfull_ = true;
}

void FlowIndex::connect_macro_b(int at, const std::string& label) {
  FlowEntry& entry = entries[static_cast<std::size_t>(at)];
  if (entry.keyword == Keyword::program) {
    end_scope();
    sub_ = at;
    entry.sub = at;
    name(at, label, false);
    return;
  }
  entry.sub = sub_;
  if (entry.keyword == Keyword::end_) return close_loop(at, label);
  const bool open = std::any_of(open_.begin(), open_.end(),
                                [&](const Open& other) { return other.label == label; });
  if (open)
    problem(
        at, FlowFault::nesting,
        "DO" + label + " inside DO" + label + "; loops inside each other need different numbers");
  entry.next = open_.empty() ? -1 : open_.back().at;
  if (open_.size() >= max_open)
    return problem(at, FlowFault::limit, "more than 1000 loops inside each other");
  open_.push_back({at, entry.keyword, label});
}

void FlowIndex::close_loop(int at, const std::string& label) {
  const auto fits = [&](const Open& other) { return other.label == label; };
  if (std::none_of(open_.begin(), open_.end(), fits))
    return problem(at, FlowFault::missing, "there is no DO" + label + " before this END");
  while (!fits(open_.back())) {
    const Open& crossed = open_.back();
    problem(crossed.at, FlowFault::nesting,
            "DO" + crossed.label + " is not closed before END" + label +
                "; loops can't cross each other");
    open_.pop_back();
  }
  entries[static_cast<std::size_t>(at)].partner = open_.back().at;
  entries[static_cast<std::size_t>(open_.back().at)].partner = at;
  open_.pop_back();
}

int FlowIndex::program_at(std::uint64_t begin) {
  const std::size_t behind = entries.lower_bound(
      begin, [](const FlowEntry& entry, std::uint64_t b) { return entry.begin <= b; });
  return behind == 0 ? -1 : entries[behind - 1].sub;
}

// A loop made of jumps asks for the same ones again and again.
std::optional<NumberedBlock> FlowIndex::find_block(std::int64_t number, std::uint64_t from) {
  if (number < 0 || number > (1 << 30)) return std::nullopt;
  Jump& jump = jumps_[(from * 31 + static_cast<std::uint64_t>(number)) % jumps_.size()];
  if (jump.number != number || jump.from != from) jump = {number, from, search(number, from)};
  return jump.found;
}

std::optional<NumberedBlock> FlowIndex::search(std::int64_t number, std::uint64_t from) {
  const int program = program_at(from);
  const auto wanted = static_cast<std::int32_t>(number);
  for (const std::uint64_t begin : {from + 1, std::uint64_t{0}}) {
    const std::size_t at = numbered_.lower_bound(
        std::tuple(program, wanted, begin), [](const Numbered& block, const auto& value) {
          return std::tie(block.program, block.number, block.begin) < value;
        });
    if (at == numbered_.size()) continue;
    const Numbered block = numbered_[at];
    if (block.program != program || block.number != wanted) continue;
    const LineExtent extent = find_line_end(source_.content(), block.begin);
    return NumberedBlock{wanted, block.loop, {block.begin, extent.next, block.line}};
  }
  return std::nullopt;
}

}  // namespace aircut::interp
