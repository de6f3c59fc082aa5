// Nodes in equal steps of time, on an estimate of the ride: near a stop x ~ t³, elsewhere the
// second-order profile; then, on the coarse result, again in finer steps. Where nothing changes the
// cells grow: `active` are the places where the speed or the path's bend takes a part of a limit,
// and a cell may be the longer the farther away in time the next of them is.
#include "plan/jerk_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace aircut::plan {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
// At a stop the smoothed law lasts half a cell longer than the nodes' times; nodes half a cell
// later give equal times there.
constexpr double half_cell = 0.5;

/// A place of an estimated ride, for the choice of nodes.
struct Place {
  double x, v, t;
  double target;  ///< wanted duration of a cell here, s
  double count;   ///< cells before it
  bool active;    ///< something changes here
};

// How many cells lie before each place.
void place_counts(std::vector<Place>& places) {
  places.front().count = 0;
  for (std::size_t i = 1; i < places.size(); ++i)
    places[i].count = places[i - 1].count + (places[i].t - places[i - 1].t) * 2 /
                                                (places[i].target + places[i - 1].target);
}

// Places around which the path alone, passed at a steady speed, takes a good part of a jerk limit.
void mark_bends(const JerkWindow& w, std::vector<Place>& places) {
  constexpr double much = 0.05;
  std::size_t k = 0;
  for (std::size_t i = 0; i + 1 < w.stations.size(); ++i) {
    const double h = w.stations[i + 1].x - w.stations[i].x;
    while (k + 2 < places.size() && places[k + 1].x <= w.stations[i].x) ++k;
    const double v = std::max(places[k].v, places[k + 1].v);
    for (std::size_t j = 0; j < w.joints; ++j) {
      const double rate = w.rate[static_cast<Eigen::Index>(j)];
      const double bend = std::abs(w.beta[(i + 1) * w.joints + j] - w.beta[i * w.joints + j]);
      // A jump of the curvature counts over one period.
      if (bend * v * v / rate > much * std::max(h / std::max(v, 1e-300), w.period)) {
        for (std::size_t p = k; p < places.size() && places[p].x <= w.stations[i + 1].x; ++p)
          places[p].active = true;
        if (k + 1 < places.size()) places[k + 1].active = true;
        break;
      }
    }
  }
}

// Wanted durations of cells: the step where something changes, longer the farther away that is.
void put_targets(const JerkWindow& w, std::vector<Place>& places, double step) {
  double longest_jerk = 0;
  for (Eigen::Index j = 0; j < w.rate.size(); ++j)
    if (std::isfinite(w.rate[j])) longest_jerk = std::max(longest_jerk, 1 / w.rate[j]);
  places.front().active = places.back().active = true;
  mark_bends(w, places);
  constexpr double growth = 0.05, longest = 20;
  double quiet = 0;
  const auto visit = [&](Place& place, double time) {
    quiet = place.active ? 0 : quiet + time;
    return step * std::clamp(1 + growth * (quiet - longest_jerk) / step, 1.0, longest);
  };
  for (std::size_t i = 0; i < places.size(); ++i)
    places[i].target = visit(places[i], i > 0 ? places[i].t - places[i - 1].t : 0);
  quiet = 0;
  for (std::size_t i = places.size(); i-- > 0;)
    places[i].target =
        std::min(places[i].target,
                 visit(places[i], i + 1 < places.size() ? places[i + 1].t - places[i].t : 0));
  // The joints' directions may change only a little within a cell.
  constexpr double turn = 0.05;
  std::size_t i = 0;
  for (Place& place : places) {
    while (i + 2 < w.stations.size() && w.stations[i + 1].x <= place.x) ++i;
    double alpha = 0, beta = 0;
    for (std::size_t j = 0; j < w.joints; ++j) {
      alpha = std::max(alpha, std::abs(w.alpha[i * w.joints + j]));
      beta = std::max(beta, std::abs(w.beta[i * w.joints + j]));
    }
    const double rate = beta * place.v;
    if (rate * place.target > turn * alpha)
      place.target = std::max(turn * alpha / rate, std::min(place.target, step));
  }
  place_counts(places);
}

// Chooses nodes by an estimate of the time.
class Mesher {
 public:
  Mesher(const JerkWindow& window, double step)
      : w_(window), step_(step), begin_(window.start.x), end_(window.end()) {}

  std::vector<double> make();

 private:
  static Place place(double x) { return {x, 0, 0, 0, 0, false}; }
  void put_places();
  void put_stop(double stop, double jerk, double sense);
  void put_speeds();
  void put_times();

  const JerkWindow& w_;
  double step_;
  double begin_, end_;
  double start_jerk_ = infinity, end_jerk_ = infinity;
  std::vector<Place> places_;
};

// From a stop on, with the jerk's limit: x = j t³ / 6. Places until the profile is slower.
void Mesher::put_stop(double stop, double jerk, double sense) {
  if (!std::isfinite(jerk)) return;
  const double dt = step_ / 4;
  for (int k = 1; k < 100000; ++k) {
    const double t = k * dt;
    const double x = stop + sense * jerk * t * t * t / 6;
    if (x <= begin_ || x >= end_) return;
    places_.push_back(place(x));
    if (t > 4 * w_.brake_time) return;
  }
}

void Mesher::put_places() {
  const auto& stations = w_.stations;
  for (std::size_t i = 0; i + 1 < stations.size(); ++i) {
    const double x0 = std::max(stations[i].x, begin_), x1 = std::min(stations[i + 1].x, end_);
    if (!(x1 > x0)) continue;
    const double sum = std::sqrt(stations[i].b) + std::sqrt(stations[i + 1].b);
    const double time = 2 * (x1 - x0) / std::max(sum, 1e-300);
    const int parts = static_cast<int>(std::clamp(time / (2 * step_), 1.0, 1000.0));
    for (int k = 0; k < parts; ++k) places_.push_back(place(x0 + (x1 - x0) * k / parts));
  }
  places_.push_back(place(end_));
  const auto joints = static_cast<std::ptrdiff_t>(w_.joints);
  const auto stations_end = places_.size();
  if (w_.start.from_rest) {
    start_jerk_ = path_jerk(w_.alpha.data(), w_.rate);
    put_stop(begin_, start_jerk_, 1);
  }
  const auto start_end = places_.size();
  end_jerk_ = path_jerk(w_.alpha.data() + w_.alpha.size() - joints, w_.rate);
  put_stop(end_, end_jerk_, -1);
  // Three runs, each in order (the last one backwards).
  const auto before = [](const Place& a, const Place& b) { return a.x < b.x; };
  const auto at = [this](std::size_t i) {
    return places_.begin() + static_cast<std::ptrdiff_t>(i);
  };
  std::reverse(at(start_end), places_.end());
  std::inplace_merge(places_.begin(), at(stations_end), at(start_end), before);
  std::inplace_merge(places_.begin(), at(start_end), places_.end(), before);
  const auto same = [](const Place& a, const Place& b) { return a.x == b.x; };
  places_.erase(std::unique(places_.begin(), places_.end(), same), places_.end());
}

void Mesher::put_speeds() {
  const auto& stations = w_.stations;
  std::size_t i = 0;
  for (Place& place : places_) {
    while (i + 2 < stations.size() && stations[i + 1].x <= place.x) ++i;
    const double b =
        linear(place.x, stations[i].x, stations[i + 1].x, stations[i].b, stations[i + 1].b);
    place.v = std::sqrt(std::max(b, 0.0));
  }
}

void Mesher::put_times() {
  const auto from_stop = [](double way, double jerk) {
    return std::isfinite(jerk) ? std::cbrt(6 * std::max(way, 0.0) / jerk) : 0.0;
  };
  for (std::size_t i = 1; i < places_.size(); ++i) {
    const Place& a = places_[i - 1];
    Place& b = places_[i];
    const double mean = 2 * (b.x - a.x) / std::max(a.v + b.v, 1e-300);
    const double up = w_.start.from_rest ? from_stop(b.x - begin_, start_jerk_) -
                                               from_stop(a.x - begin_, start_jerk_)
                                         : 0;
    const double down = from_stop(end_ - a.x, end_jerk_) - from_stop(end_ - b.x, end_jerk_);
    double time = std::max(mean, std::max(up, down));
    if (!(a.v + b.v > 0)) time = std::max(up, down);  // a way between two stops
    b.t = a.t + time;
  }
}

std::vector<double> Mesher::make() {
  put_places();
  put_speeds();
  put_times();
  for (std::size_t i = 0; i < places_.size(); ++i)
    for (const std::size_t k : {i - 1, i + 1})
      if (k < places_.size() && std::abs(places_[k].v - places_[i].v) > 1e-4 * places_[i].v)
        places_[i].active = true;
  put_targets(w_, places_, step_);
  const double cells = std::max(std::ceil(places_.back().count), 24.0);
  const double lead = w_.start.from_rest ? half_cell : 0;
  std::vector<double> out = {begin_};
  std::size_t i = 0;
  const double total = places_.back().t;
  for (double k = 1; k < cells; ++k) {
    const double wanted = places_.back().count * (k + lead) / (cells + lead + half_cell);
    while (i + 2 < places_.size() && places_[i + 1].count <= wanted) ++i;
    const Place &a = places_[i], &b = places_[i + 1];
    const double t = linear(wanted, a.count, b.count, a.t, b.t);
    double x = linear(t, a.t, b.t, a.x, b.x);
    // Next to a stop x goes with the cube of the time.
    const double up = begin_ + start_jerk_ * t * t * t / 6;
    const double left = total - t, down = end_ - end_jerk_ * left * left * left / 6;
    if (w_.start.from_rest && up > a.x && up < b.x) x = up;
    if (down > a.x && down < b.x) x = down;
    if (x > out.back() && x < end_) out.push_back(x);
  }
  out.push_back(end_);
  return out;
}

// The window's known nodes instead of the first ones. Cells between them are as they are.
void keep_known(const JerkWindow& w, std::vector<double>& nodes, std::vector<double>& wanted) {
  const std::vector<double>& known = w.start.known_x;
  if (known.empty() || !(known.back() < nodes.back())) return;
  // A cell to the first new node that is not too short.
  const double after =
      known.back() + (known.back() - known.front()) / (2 * static_cast<double>(known.size()));
  const auto next = static_cast<std::size_t>(
      std::upper_bound(nodes.begin(), nodes.end() - 1, after) - nodes.begin());
  std::vector<double> out = known, times(known.size(), infinity);
  out.insert(out.end(), nodes.begin() + static_cast<std::ptrdiff_t>(next), nodes.end());
  times.insert(times.end(), wanted.begin() + static_cast<std::ptrdiff_t>(next), wanted.end());
  nodes = std::move(out);
  wanted = std::move(times);
}

}  // namespace

std::vector<double> first_mesh(const JerkWindow& window, double step) {
  std::vector<double> nodes = Mesher(window, step).make();
  std::vector<double> wanted(nodes.size() - 1, step);
  keep_known(window, nodes, wanted);
  return nodes;
}

std::vector<double> mesh_on(const JerkWindow& w, const WindowLaw& law, double step,
                            std::vector<double>& wanted) {
  std::vector<Place> places;
  constexpr double hardly = 2e-3;  // share of an acceleration limit
  double steepest = 0;
  for (const double alpha : w.alpha) steepest = std::max(steepest, std::abs(alpha));
  for (const LawKnot& k : law.knots) {
    places.push_back({k.x, k.v, k.t, 0, 0, std::abs(k.a) * steepest > hardly});
  }
  put_targets(w, places, step);
  std::size_t i = 0;
  double first = 0;  // a law that goes on begins half a cell before the first node
  if (!w.start.from_rest) {
    const double t = law.node_time.front();
    while (i + 2 < places.size() && places[i + 1].t <= t) ++i;
    first = linear(t, places[i].t, places[i + 1].t, places[i].count, places[i + 1].count);
  }
  const double all = places.back().count - first;
  const double cells = std::max(std::ceil(all), 24.0);
  const double lead = w.start.from_rest ? half_cell : 0;
  std::vector<double> out = {w.start.x};
  for (double k = 1; k < cells; ++k) {
    const double count = first + all * (k + lead) / (cells + lead + half_cell);
    while (i + 2 < places.size() && places[i + 1].count <= count) ++i;
    const LawKnot& knot = law.knots[i];
    const double tau =
        linear(count, places[i].count, places[i + 1].count, 0, places[i + 1].t - places[i].t);
    const double x = knot.way(tau);
    if (!(x > out.back()) || !(x < w.end())) continue;
    out.push_back(x);
    wanted.push_back(places[i].target);
  }
  out.push_back(w.end());
  wanted.push_back(places.back().target);
  keep_known(w, out, wanted);
  return out;
}

bool is_fine(const std::vector<double>& time, const std::vector<double>& wanted) {
  for (std::size_t k = 0; k < time.size(); ++k)
    if (time[k] > 1.2 * wanted[k]) return false;
  return true;
}

}  // namespace aircut::plan
