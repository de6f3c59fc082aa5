#include "sim/checks/worst_rows.h"

#include <algorithm>

namespace aircut::sim {

namespace {

// The front of a heap is what counts as the largest: the least bad, of equal ones the latest.
constexpr auto before = [](const auto& a, const auto& b) {
  return a.badness != b.badness ? a.badness > b.badness : a.finding.t_first < b.finding.t_first;
};

}  // namespace

bool WorstRows::wants(double badness) {
  if (rows_.size() < keep_ || badness > rows_.front().badness) return true;
  ++left_out_;
  return false;
}

void WorstRows::add(double badness, Finding row) {
  if (rows_.size() >= keep_) {
    std::pop_heap(rows_.begin(), rows_.end(), before);
    rows_.pop_back();
    ++left_out_;
  }
  rows_.push_back({badness, std::move(row)});
  std::push_heap(rows_.begin(), rows_.end(), before);
}

void WorstRows::hand_over(const std::string& what, Findings& out) {
  std::sort(rows_.begin(), rows_.end(), before);
  if (left_out_ > 0 && !rows_.empty())
    rows_.front().finding.message += "; " + std::to_string(left_out_) + " more " + what +
                                     " that are less far off are not listed";
  std::sort(rows_.begin(), rows_.end(),
            [](const Row& a, const Row& b) { return a.finding.t_first < b.finding.t_first; });
  for (Row& row : rows_) out.add(std::move(row.finding));
  rows_.clear();
}

}  // namespace aircut::sim
