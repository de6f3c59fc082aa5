// Private: rows against the programmed path.
#pragma once

#include <deque>

#include "logbook/logbook.h"

namespace aircut::logbook {

class PathCheck {
 public:
  /// `factors`: what overrides may have made of the programmed feed.
  PathCheck(IdealPath next, std::vector<double> factors)
      : next_(std::move(next)), factors_(std::move(factors)) {}

  void row(const Row& row, Check& out);
  /// After the last row.
  void finish(Check& out);

 private:
  struct Piece {
    IdealPiece ideal;
    double length = 0;
    double nearest_end = 1e300;  ///< of a row to its end
  };
  void read_up_to(std::uint64_t block);
  void drop_before(std::size_t own, Check& out);
  void judge_end(const Piece& piece, Check& out) const;
  void check_feed(const Row& row, const Piece& piece, Check& out);

  IdealPath next_;
  std::vector<double> factors_;
  bool ended_ = false;
  std::deque<Piece> pieces_;  ///< around the row's block
  bool has_last_ = false;
  Point last_{};
  double stride_ = 0;  ///< longest way between two rows
  bool feed_told_ = false;
  bool off_ = false;  ///< the last row was off the path
};

/// Adds a problem; beyond twenty they are only counted.
void add_problem(Check& check, std::string text);

}  // namespace aircut::logbook
