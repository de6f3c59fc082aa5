// Limits by finite differences of the joints' positions over the period T:
//
//   speed         (q1 − q0) / T
//   acceleration  (q2 − 2 q1 + q0) / T²
//   jerk          (q3 − 3 q2 + 3 q1 − q0) / T³
//
// Before the first and after the last row the machine stands: the ends are continued with copies.
// A position is a double and the time of a row too, so each difference carries the rounding of its
// terms; that much is forgiven. The feed is the way of the tip (XYZ, else UVW, else ABC) between
// two rows over T.
#include <algorithm>
#include <cmath>
#include <limits>

#include "logbook/path_check.h"

namespace aircut::logbook {
namespace {

constexpr double allowed = 1.001;

class Judge {
 public:
  Judge(const Header& header, const IdealPath& path);
  void row(Row row);
  Check finish();

 private:
  void note(Peak& peak, double share, const Row& row);
  void form(const Row& row);
  void differences();
  void feed(const Row& a, const Row& b);

  Check out_;
  double period_;
  std::size_t joints_;
  bool thinned_;
  std::vector<Row> last_;  ///< the last four rows
  std::optional<PathCheck> path_;
};

Judge::Judge(const Header& header, const IdealPath& path)
    : period_(header.period), joints_(header.joints.size()), thinned_(header.every != 1) {
  out_.header = header;
  for (const Joint& joint : header.joints)
    out_.peaks.push_back({"speed", joint.name, joint.v_max, 0, 0, 0, 0});
  for (const Joint& joint : header.joints)
    out_.peaks.push_back({"acceleration", joint.name, joint.a_max, 0, 0, 0, 0});
  for (const Joint& joint : header.joints)
    out_.peaks.push_back({"jerk", joint.name, joint.j_max, 0, 0, 0, 0});
  out_.peaks.push_back({"feed", "", 0, 0, 0, 0, 0});
  if (path) path_.emplace(path, header.feed_factors);
  out_.has_path = path_.has_value();
}

void Judge::note(Peak& peak, double share, const Row& row) {
  if (share > allowed) ++peak.rows_over;
  if (share <= peak.share) return;
  peak.share = share;
  peak.t = row.t();
  peak.line = row.line();
}

void Judge::form(const Row& row) {
  const double steps = row.t() / period_, wanted = static_cast<double>(out_.rows);
  const double off = thinned_ ? steps - std::round(steps) : steps - wanted;
  if (std::abs(off) > 1e-6 + 1e-12 * steps)
    add_problem(out_, "row " + std::to_string(out_.rows + 1) + " is at t = " + shortest(row.t()) +
                          " s, not at a multiple of the period");
}

// Of the four rows in last_.
void Judge::differences() {
  const double t2 = period_ * period_, epsilon = std::numeric_limits<double>::epsilon();
  for (std::size_t j = 0; j < joints_; ++j) {
    const Joint& joint = out_.header.joints[j];
    const double q0 = last_[0].q(j), q1 = last_[1].q(j), q2 = last_[2].q(j), q3 = last_[3].q(j);
    const double size = std::max({std::abs(q0), std::abs(q1), std::abs(q2), std::abs(q3)});
    const double rounding = epsilon * (size + std::abs(q3 - q2) / period_ * last_[3].t());
    const auto share = [&](double difference, double terms, double time, double limit) {
      const double value = std::abs(difference) - terms * rounding;
      if (!std::isfinite(value)) return std::numeric_limits<double>::infinity();
      return std::max(value, 0.0) / time / limit;
    };
    note(out_.peaks[j], share(q3 - q2, 1, period_, joint.v_max), last_[3]);
    note(out_.peaks[joints_ + j], share(q3 - 2 * q2 + q1, 2, t2, joint.a_max), last_[2]);
    note(out_.peaks[2 * joints_ + j],
         share(q3 - 3 * q2 + 3 * q1 - q0, 4, t2 * period_, joint.j_max), last_[2]);
  }
}

void Judge::feed(const Row& a, const Row& b) {
  if (!(a.feed_command() > 0) || !(b.feed_command() > 0)) return;
  constexpr unsigned other_tip = 256;  // by a new length or kinematics: no way that was gone
  if ((b.flags() & other_tip) != 0) return;
  const auto way = [&](std::size_t i) {
    return std::hypot(b.tip(i) - a.tip(i), b.tip(i + 1) - a.tip(i + 1),
                      b.tip(i + 2) - a.tip(i + 2));
  };
  constexpr double none = 1e-9;
  double length = way(0);
  if (length < none) length = way(6);
  if (length < none) length = way(3);
  if (!std::isfinite(length)) length = std::numeric_limits<double>::max();
  note(out_.peaks.back(), length / period_ / std::max(a.feed_command(), b.feed_command()), b);
}

void Judge::row(Row row) {
  form(row);
  ++out_.rows;
  if (path_) path_->row(row, out_);
  if (last_.empty()) {
    last_.assign(4, row);
    return;
  }
  std::rotate(last_.begin(), last_.begin() + 1, last_.end());
  last_[3] = std::move(row);
  if (thinned_) return;
  feed(last_[2], last_[3]);
  differences();
}

Check Judge::finish() {
  if (out_.rows != out_.header.samples)
    add_problem(out_, "the header says " + std::to_string(out_.header.samples) +
                          " rows, there are " + std::to_string(out_.rows) +
                          ": the file is not complete");
  if (out_.rows == 0) {
    out_.unchecked.push_back("everything: there are no rows");
    return std::move(out_);
  }
  const Row end = last_[3];
  for (std::size_t j = 0; j < joints_; ++j)
    if (end.v(j) != 0) {
      add_problem(out_, "the last row is not at rest");
      break;
    }
  if (end.t() < out_.header.end_time - 1e-6 * period_)
    add_problem(out_, "the last row is before the program's end");
  if ((end.flags() & 128) != 0)
    add_problem(out_, "the run ended at line " + std::to_string(end.line()) +
                          " because the program could not go on");
  if (thinned_) {
    out_.peaks.clear();
    out_.unchecked.push_back("the limits: only every " + std::to_string(out_.header.every) +
                             "th sample is there; write the log with --log-every 1");
  } else {
    for (int k = 0; k < 3; ++k) {
      std::rotate(last_.begin(), last_.begin() + 1, last_.end());
      last_[3] = end;
      differences();
    }
  }
  if (path_) path_->finish(out_);
  return std::move(out_);
}

}  // namespace

Expected<Check> check(const SourceText& log, const IdealPath& path) {
  auto reader = Reader::open(log);
  if (!reader) return unexpected(reader.error());
  Judge judge(reader->header(), path);
  for (Row row;;) {
    const auto more = reader->next(row);
    if (!more) return unexpected(more.error());
    if (!*more) break;
    judge.row(row);
  }
  return judge.finish();
}

}  // namespace aircut::logbook
