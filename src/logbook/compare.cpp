// Two logs at equal times. What one has and the other has not any more counts as standing at its
// last row.
#include <algorithm>
#include <cmath>

#include "logbook/logbook.h"

namespace aircut::logbook {
namespace {

struct Side {
  Reader reader;
  Row row;
  bool ended = false;

  Expected<void> step() {
    if (ended) return {};
    Row next = row;
    const auto more = reader.next(next);
    if (!more) return unexpected(more.error());
    if (*more)
      row = std::move(next);
    else
      ended = true;
    return {};
  }
};

void note(Comparison& out, std::size_t which, double value, const Row& a, const Row& b) {
  Comparison::Difference& d = out.differences[which];
  if (!(value > d.most)) return;
  d.most = value;
  d.t = std::max(a.t(), b.t());
  d.line_a = a.line();
  d.line_b = b.line();
}

void compare_rows(Comparison& out, const Row& a, const Row& b, double tolerance) {
  const double tip = std::hypot(a.tip(0) - b.tip(0), a.tip(1) - b.tip(1), a.tip(2) - b.tip(2));
  note(out, 0, tip, a, b);
  note(out, 1, std::abs(a.feed() - b.feed()), a, b);
  note(out, 2, std::abs(a.rpm() - b.rpm()), a, b);
  note(out, 3, a.tool() == b.tool() ? 0 : 1, a, b);
  bool differs = tip > tolerance || a.rpm() != b.rpm() || a.tool() != b.tool();
  for (std::size_t j = 0; j < a.joints; ++j) {
    const double way = std::abs(a.q(j) - b.q(j));
    note(out, 4 + j, way, a, b);
    differs = differs || way > tolerance;
  }
  if (differs && !out.first) out.first = std::max(a.t(), b.t());
}

}  // namespace

Expected<Comparison> compare(const SourceText& a, const SourceText& b, double tolerance) {
  auto reader_a = Reader::open(a), reader_b = Reader::open(b);
  if (!reader_a) return unexpected(reader_a.error());
  if (!reader_b) return unexpected(reader_b.error());
  const Header head_a = reader_a->header(), head_b = reader_b->header();
  for (const char* key : {"joints", "servo_period_s", "every"})
    if (head_a.keys.at(key) != head_b.keys.at(key))
      return unexpected(
          make_error("input", std::string("these logs can't be compared row by row: '") + key +
                                  "' is '" + printable(head_a.keys.at(key)) + "' in one and '" +
                                  printable(head_b.keys.at(key)) + "' in the other"));
  Comparison out;
  out.end_a = head_a.end_time;
  out.end_b = head_b.end_time;
  out.differences = {{"tip", "mm", 0, 0, 0, 0},
                     {"feed", "mm/s", 0, 0, 0, 0},
                     {"spindle", "rev/min", 0, 0, 0, 0},
                     {"tool", "", 0, 0, 0, 0}};
  for (const Joint& joint : head_a.joints)
    out.differences.push_back({"joint " + joint.name, joint.unit, 0, 0, 0, 0});
  for (const auto& [key, value] : head_a.keys) {
    const auto other = head_b.keys.find(key);
    if (other == head_b.keys.end() || other->second != value)
      out.headers.push_back(key + ": " + value + " | " +
                            (other == head_b.keys.end() ? "" : other->second));
  }
  Side one{std::move(*reader_a), {}}, two{std::move(*reader_b), {}};
  for (;;) {
    for (Side* side : {&one, &two})
      if (auto done = side->step(); !done) return unexpected(done.error());
    if ((one.ended && two.ended) || one.row.values.empty() || two.row.values.empty()) break;
    compare_rows(out, one.row, two.row, tolerance);
  }
  out.rows_a = one.reader.rows();
  out.rows_b = two.reader.rows();
  if (out.rows_a != out.rows_b && !out.first) out.first = std::min(out.end_a, out.end_b);
  return out;
}

}  // namespace aircut::logbook
