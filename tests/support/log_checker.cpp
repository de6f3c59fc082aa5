#include "support/log_checker.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace aircut::test {
namespace {

using Point = std::array<double, 3>;

std::vector<std::string> split(const std::string& text, char by) {
  std::vector<std::string> out;
  std::string item;
  std::istringstream in(text);
  while (std::getline(in, item, by)) out.push_back(item);
  return out;
}

std::vector<double> numbers(const std::string& text) {
  std::vector<double> out;
  for (const std::string& item : split(text, ','))
    out.push_back(std::strtod(item.c_str(), nullptr));
  return out;
}

std::string place(const JointLog& log, std::size_t row, const std::string& what, double share) {
  std::ostringstream out;
  out.precision(10);
  out << what << " at row " << row << ", t " << log.rows[row][0] << ", line "
      << log.value(row, "line") << ": " << share;
  return out.str();
}

void note(Worst& worst, const JointLog& log, std::size_t row, const char* what, double share) {
  if (!(share <= worst.share)) worst = {share, place(log, row, what, share)};
}

double distance(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Point add(const Point& a, double f, const Point& b) {
  return {a[0] + f * b[0], a[1] + f * b[1], a[2] + f * b[2]};
}

struct Piece {
  int block = 0;
  double tolerance = 0;
  bool arc = false;
  Point start{}, end{}, centre{}, normal{};
  int turns = 1;

  Point at(double f) const {
    if (!arc) return add(start, f, add(end, -1, start));
    const Point from = add(start, -1, centre), to = add(end, -1, centre);
    const double h0 = dot(from, normal), h1 = dot(to, normal);
    const Point r0 = add(from, -h0, normal), r1 = add(to, -h1, normal);
    const double size0 = std::sqrt(dot(r0, r0)), size1 = std::sqrt(dot(r1, r1));
    double angle = std::atan2(dot(cross(normal, r0), r1), dot(r0, r1));
    const double pi = std::acos(-1.0);
    if (turns > 0 && angle <= 1e-9) angle += 2 * pi;
    if (turns < 0 && angle >= -1e-9) angle -= 2 * pi;
    angle += 2 * pi * (turns - (turns > 0 ? 1 : -1));
    const double phi = f * angle, scale = 1 + f * (size1 / size0 - 1);
    Point p = add(centre, h0 + f * (h1 - h0), normal);
    p = add(p, scale * std::cos(phi), r0);
    return add(p, scale * std::sin(phi), cross(normal, r0));
  }

  double distance_to(const Point& p) const {
    if (!arc) {
      const Point way = add(end, -1, start);
      const double length2 = dot(way, way);
      const double f =
          length2 > 0 ? std::clamp(dot(add(p, -1, start), way) / length2, 0.0, 1.0) : 0;
      return distance(p, at(f));
    }
    // Thirds around every sample that is nearer than its neighbours.
    const int n = 24 * std::abs(turns);
    std::vector<double> off;
    for (int i = 0; i <= n; ++i) off.push_back(distance(p, at(double(i) / n)));
    double nearest = *std::min_element(off.begin(), off.end());
    for (int i = 0; i <= n; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if ((i > 0 && off[k - 1] < off[k]) || (i < n && off[k + 1] < off[k])) continue;
      double low = std::max(0.0, double(i - 1) / n), high = std::min(1.0, double(i + 1) / n);
      while (high - low > 1e-8) {
        const double c = low + (high - low) / 3, d = high - (high - low) / 3;
        if (distance(p, at(c)) < distance(p, at(d)))
          high = d;
        else
          low = c;
      }
      nearest = std::min(nearest, distance(p, at((low + high) / 2)));
    }
    return nearest;
  }
};

std::vector<Piece> read_pieces(const std::string& text) {
  std::vector<Piece> out;
  std::istringstream in(text);
  std::string line, kind;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    Piece piece;
    words >> piece.block >> piece.tolerance >> kind;
    piece.arc = kind == "arc";
    for (double& v : piece.start) words >> v;
    for (double& v : piece.end) words >> v;
    if (piece.arc) {
      for (double& v : piece.centre) words >> v;
      for (double& v : piece.normal) words >> v;
      words >> piece.turns;
    }
    if (words) out.push_back(piece);
  }
  return out;
}

std::vector<Point> tips(const JointLog& log) {
  const std::size_t x = log.column("x");
  std::vector<Point> out;
  for (const auto& row : log.rows) out.push_back({row[x], row[x + 1], row[x + 2]});
  return out;
}

}  // namespace

std::size_t JointLog::column(const std::string& name) const {
  // Joint columns come first, so "v" and "a" alone mean the pose's letters.
  const auto found = std::find(columns.begin(), columns.end(), name);
  return static_cast<std::size_t>(found - columns.begin());
}

JointLog read_log(const std::string& text) {
  JointLog log;
  if (text.empty() || text.back() != '\n') log.problems.push_back("no line end at the end");
  if (text.find('\r') != std::string::npos) log.problems.push_back("carriage returns");
  for (const std::string& line : split(text, '\n')) {
    if (line.starts_with("# ")) {
      const auto equals = line.find('=');
      if (equals == std::string::npos || !log.columns.empty())
        log.problems.push_back("stray header line: " + line);
      else {
        log.header[line.substr(2, equals - 2)] = line.substr(equals + 1);
        log.header_order.push_back(line.substr(2, equals - 2));
      }
    } else if (log.columns.empty()) {
      log.columns = split(line, ',');
    } else {
      log.rows.push_back(numbers(line));
      if (log.rows.back().size() != log.columns.size()) log.problems.push_back("row: " + line);
      for (const double v : log.rows.back())
        if (!std::isfinite(v)) log.problems.push_back("not finite: " + line);
    }
  }
  for (const std::string& joint : split(log.header["joints"], ','))
    log.joint_names.push_back(joint.substr(0, joint.find(':')));
  log.v_max = numbers(log.header["limits_v"]);
  log.a_max = numbers(log.header["limits_a"]);
  log.j_max = numbers(log.header["limits_j"]);
  log.period = std::strtod(log.header["servo_period_s"].c_str(), nullptr);
  log.end_time = std::strtod(log.header["end_time_s"].c_str(), nullptr);
  if (!log.problems.empty() || log.rows.empty()) return log;
  if (log.header["format"] != "aircut-joints-1") log.problems.push_back("format");
  if (std::to_string(log.rows.size()) != log.header["samples"]) log.problems.push_back("samples");
  for (std::size_t k = 0; k < log.rows.size(); ++k)
    if (log.header["every"] == "1" && log.rows[k][0] != static_cast<double>(k) * log.period)
      log.problems.push_back(place(log, k, "time", log.rows[k][0]));
  const double last = log.rows.back()[0];
  if (last < log.end_time * (1 - 1e-12) - 1e-9 * log.period ||
      last >= log.end_time + log.period * (1 + 1e-6))
    log.problems.push_back("the last row is not the first at or after the end");
  for (std::size_t j = 0; j < log.joints(); ++j)
    if (log.rows.back()[log.column("v" + std::to_string(j))] != 0)
      log.problems.push_back("the last row is not at rest");
  return log;
}

Worst worst_velocity(const JointLog& log) {
  Worst worst;
  for (std::size_t j = 0; j < log.joints(); ++j) {
    const std::size_t q = log.column("q" + std::to_string(j));
    for (std::size_t k = 0; k + 1 < log.rows.size(); ++k)
      note(worst, log, k, "velocity",
           std::abs(log.rows[k + 1][q] - log.rows[k][q]) / log.period / log.v_max[j]);
  }
  return worst;
}

Worst worst_acceleration(const JointLog& log) {
  Worst worst;
  const std::size_t n = log.rows.size();
  for (std::size_t j = 0; j < log.joints(); ++j) {
    const std::size_t q = log.column("q" + std::to_string(j));
    // The ends are padded with copies: the machine stood still before and stands still after.
    const auto at = [&](std::size_t padded) {
      return log.rows[std::clamp<std::size_t>(padded, 4, n + 3) - 4][q];
    };
    for (std::size_t k = 1; k + 1 < n + 8; ++k)
      note(worst, log, std::clamp<std::size_t>(k, 4, n + 3) - 4, "acceleration",
           std::abs(at(k + 1) - 2 * at(k) + at(k - 1)) / (log.period * log.period) / log.a_max[j]);
  }
  return worst;
}

Worst worst_jerk(const JointLog& log) {
  Worst worst;
  const std::size_t n = log.rows.size();
  const double t3 = log.period * log.period * log.period;
  for (std::size_t j = 0; j < log.joints(); ++j) {
    const std::size_t q = log.column("q" + std::to_string(j));
    const auto at = [&](std::size_t padded) {
      return log.rows[std::clamp<std::size_t>(padded, 4, n + 3) - 4][q];
    };
    // Positions are doubles: their rounding alone counts as 8 units in the last place per T³.
    for (std::size_t k = 0; k + 3 < n + 8; ++k) {
      const double rounding = 8 * 2.3e-16 * std::abs(at(k));
      const double jerk = std::abs(at(k + 3) - 3 * at(k + 2) + 3 * at(k + 1) - at(k));
      note(worst, log, std::clamp<std::size_t>(k, 4, n + 3) - 4, "jerk",
           std::max(jerk - rounding, 0.0) / t3 / log.j_max[j]);
    }
  }
  return worst;
}

Worst worst_feed(const JointLog& log) {
  Worst worst;
  const std::size_t feed = log.column("feed_cmd");
  const std::size_t x = log.column("x");
  for (std::size_t k = 0; k + 1 < log.rows.size(); ++k) {
    const auto& a = log.rows[k];
    const auto& b = log.rows[k + 1];
    if (a[feed] == 0 || b[feed] == 0) continue;
    double way = std::hypot(b[x] - a[x], b[x + 1] - a[x + 1], b[x + 2] - a[x + 2]);
    if (way < 1e-12)
      way = std::hypot(b[x + 3] - a[x + 3], b[x + 4] - a[x + 4], b[x + 5] - a[x + 5]);
    note(worst, log, k, "feed", way / log.period / std::max(a[feed], b[feed]));
  }
  return worst;
}

Worst worst_derivative(const JointLog& log) {
  Worst worst;
  for (std::size_t j = 0; j < log.joints(); ++j) {
    const std::size_t q = log.column("q" + std::to_string(j));
    const std::size_t v = log.column("v" + std::to_string(j));
    for (std::size_t k = 0; k + 1 < log.rows.size(); ++k) {
      const auto& a = log.rows[k];
      const auto& b = log.rows[k + 1];
      // Trapezoid rule: exact up to a change of acceleration by at most 2 A within the period.
      const double error = std::abs(b[q] - a[q] - log.period * (a[v] + b[v]) / 2);
      const double allowed = log.a_max[j] * log.period * log.period / 2 + 1e-9;
      note(worst, log, k, "v column", error / allowed);
    }
  }
  return worst;
}

Worst worst_path_deviation(const JointLog& log, const std::string& text, std::size_t around) {
  const std::vector<Piece> pieces = read_pieces(text);
  Worst worst{-1e300, "no pieces"};
  if (pieces.empty()) return {1e300, "no pieces"};
  std::vector<double> near_end(pieces.size(), 1e300);
  const std::vector<Point> tip = tips(log);
  const std::size_t block_column = log.column("block");
  for (std::size_t k = 0; k < log.rows.size(); ++k) {
    const auto block = static_cast<int>(log.rows[k][block_column]);
    const auto own = std::lower_bound(pieces.begin(), pieces.end(), block,
                                      [](const Piece& p, int b) { return p.block < b; });
    const auto at = static_cast<std::size_t>(own - pieces.begin());
    const std::size_t first = at < around ? 0 : at - around;
    const std::size_t last = std::min(at + around + 1, pieces.size());
    double nearest = 1e300, tolerance = 0;
    for (std::size_t i = first; i < last; ++i) {
      nearest = std::min(nearest, pieces[i].distance_to(tip[k]));
      tolerance = std::max(tolerance, pieces[i].tolerance);
      near_end[i] = std::min(near_end[i], distance(pieces[i].end, tip[k]));
    }
    note(worst, log, k, "path", nearest - tolerance);
  }
  // Between two samples the tip goes at most this far, so an end that was passed is that near.
  double stride = 0;
  for (std::size_t k = 0; k + 1 < log.rows.size(); ++k)
    stride = std::max(stride, distance(tip[k], tip[k + 1]));
  // Pieces of a few strides may lie between the samples of others altogether.
  for (std::size_t i = 0; i < pieces.size(); ++i)
    if (distance(pieces[i].start, pieces[i].end) > 5 * stride &&
        near_end[i] > stride + pieces[i].tolerance + 1e-6)
      return {near_end[i], "the end of block " + std::to_string(pieces[i].block) +
                               " is never reached: " + std::to_string(near_end[i])};
  return worst;
}

Worst worst_rod_error(const JointLog& log) {
  Worst worst;
  for (std::size_t k = 0; k < log.rows.size(); ++k) {
    const double s1 = log.value(k, "q0"), s2 = log.value(k, "q1");
    const double x = log.value(k, "x"), z = log.value(k, "z");
    note(worst, log, k, "rod 1", std::abs(std::hypot(x - 55 - s1, z + 74) - 302));
    note(worst, log, k, "rod 2", std::abs(std::hypot(x + 65 - s2, z - 74) - 432));
    note(worst, log, k, "slide", std::abs(log.value(k, "q2") - log.value(k, "y")));
  }
  return worst;
}

}  // namespace aircut::test
