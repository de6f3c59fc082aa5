// A point is reached when the inverse kinematics, asked from home, has a solution for every tilt
// and all joints are inside their travel; a turning joint may be there in another turn.
//
// Largest rectangle of a slice: for each row, the height of the run of ones that ends there, and
// the largest rectangle under that histogram by a stack of rising heights, O(n·m). Largest box: for
// each pair of a first and a last slice, the slices between are combined by AND and searched
// likewise (kinematics.md f.4).
#include "machine/workspace/workspace.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <numbers>
#include <thread>

#include "base/random.h"

namespace aircut::machine {

namespace {

// The joint beyond its travel, or −1.
int beyond(const Machine& machine, const JointVector& q) {
  constexpr double slack = 1e-9;
  constexpr double turn = 2 * std::numbers::pi;
  for (int j = 0; j < machine.joint_count(); ++j) {
    const Joint& joint = machine.joint(JointId{j});
    double value = q[j];
    if (joint.kind == JointKind::rotary && std::isfinite(joint.min))
      value += turn * std::ceil((joint.min - slack - value) / turn);
    if (!(value >= joint.min - slack && value <= joint.max + slack)) return j;
  }
  return -1;
}

struct Rectangle {
  int x0 = 0, x1 = -1, y0 = 0, y1 = -1;
  long points() const { return static_cast<long>(x1 - x0 + 1) * (y1 - y0 + 1); }
};

// `plane` has nx columns, x fastest.
Rectangle largest_rectangle(const std::vector<unsigned char>& plane, int nx, int ny) {
  Rectangle best;
  std::vector<int> height(static_cast<std::size_t>(nx) + 1, 0);
  std::vector<int> stack;
  for (int y = 0; y < ny; ++y) {
    for (int x = 0; x < nx; ++x) {
      int& h = height[static_cast<std::size_t>(x)];
      h = plane[static_cast<std::size_t>(y) * static_cast<std::size_t>(nx) +
                static_cast<std::size_t>(x)]
              ? h + 1
              : 0;
    }
    stack.clear();
    for (int x = 0; x <= nx; ++x) {  // height[nx] stays 0 and empties the stack
      while (!stack.empty() && height[static_cast<std::size_t>(stack.back())] >=
                                   height[static_cast<std::size_t>(x)]) {
        const int h = height[static_cast<std::size_t>(stack.back())];
        stack.pop_back();
        const Rectangle r{stack.empty() ? 0 : stack.back() + 1, x - 1, y - h + 1, y};
        if (h > 0 && r.points() > best.points()) best = r;
      }
      stack.push_back(x);
    }
  }
  return best;
}

}  // namespace

long GridBox::points() const {
  long n = 1;
  for (std::size_t a = 0; a < 3; ++a) n *= std::max(0, last[a] - first[a] + 1);
  return n;
}

std::optional<Workspace> Workspace::of(const Machine& machine, const WorkspaceQuery& query) {
  Workspace w;
  w.pitch_ = query.pitch;
  double points = 1;
  for (int a = 0; a < 3; ++a) {
    const double size = query.high[a] - query.low[a];
    const double steps = size / query.pitch;
    const double n = size <= 0     ? 1
                     : query.nodes ? std::floor(steps + 1e-9) + 1
                                   : std::max(1.0, std::floor(steps + 1e-9));
    points *= n;
    if (!(points <= static_cast<double>(max_points))) return std::nullopt;
    w.count_[static_cast<std::size_t>(a)] = static_cast<int>(n);
    w.first_[a] = query.low[a] + (size > 0 && !query.nodes ? query.pitch / 2 : 0);
  }
  std::vector<AxisValues> tilts = query.tilts;
  if (tilts.empty()) tilts.emplace_back();
  const JointVector home = machine.home();
  const int no_solution = machine.joint_count(), in_the_way = no_solution + 1;
  w.failures_.assign(static_cast<std::size_t>(in_the_way) + 1, 0);
  const auto reached = [&](const Vec3& p, std::vector<long>& failures) {
    for (AxisValues tip : tilts) {
      tip[Axis::x] = p.x();
      tip[Axis::y] = p.y();
      tip[Axis::z] = p.z();
      const auto q = machine.kinematics().inverse({tip, query.tool_offset}, home);
      int bad = q ? beyond(machine, *q) : no_solution;
      if (bad < 0 && query.is_free && !query.is_free(*q)) bad = in_the_way;
      if (bad < 0) continue;
      ++failures[static_cast<std::size_t>(bad)];
      return false;
    }
    return true;
  };
  // Threads take pieces of the grid as they get done; what they write and count does not depend on
  // who takes which.
  w.bits_.assign(static_cast<std::size_t>(points), 0);
  constexpr long piece = 2048;
  std::atomic<long> next = 0;
  std::mutex counting;
  const auto work = [&] {
    std::vector<long> failures(w.failures_.size(), 0);
    for (long begin; (begin = next.fetch_add(piece)) < w.points();)
      for (long n = begin; n < std::min(begin + piece, w.points()); ++n) {
        const long nx = w.count_[0], ny = w.count_[1];
        const Vec3 p = w.place(static_cast<int>(n % nx), static_cast<int>(n / nx % ny),
                               static_cast<int>(n / nx / ny));
        w.bits_[static_cast<std::size_t>(n)] = reached(p, failures) ? 1 : 0;
      }
    const std::lock_guard lock(counting);
    for (std::size_t i = 0; i < failures.size(); ++i) w.failures_[i] += failures[i];
  };
  const long cores = static_cast<long>(std::max(1u, std::thread::hardware_concurrency()));
  const long wanted = query.threads > 0 ? query.threads : cores;
  std::vector<std::thread> others;
  for (long i = 1; i < std::min(wanted, w.points() / piece + 1); ++i) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  return w;
}

Vec3 Workspace::place(int i, int j, int k) const { return first_ + pitch_ * Vec3(i, j, k); }

long Workspace::reached() const { return std::count(bits_.begin(), bits_.end(), 1); }

long Workspace::at_border() const {
  long n = 0;
  for (int k = 0; k < count_[2]; ++k)
    for (int j = 0; j < count_[1]; ++j)
      for (int i = 0; i < count_[0]; ++i) {
        if (!in(i, j, k)) continue;
        const std::array<int, 3> p = {i, j, k};
        bool border = false;
        for (std::size_t a = 0; a < 3; ++a)
          for (const int step : {-1, 1}) {
            if (count_[a] == 1) continue;
            std::array<int, 3> other = p;
            other[a] += step;
            border = border || other[a] < 0 || other[a] >= count_[a] ||
                     !in(other[0], other[1], other[2]);
          }
        n += border;
      }
  return n;
}

GridBox Workspace::extent() const {
  GridBox box;
  for (int k = 0; k < count_[2]; ++k)
    for (int j = 0; j < count_[1]; ++j)
      for (int i = 0; i < count_[0]; ++i) {
        if (!in(i, j, k)) continue;
        const std::array<int, 3> p = {i, j, k};
        if (box.last[0] < 0) box.first = box.last = p;
        for (std::size_t a = 0; a < 3; ++a) {
          box.first[a] = std::min(box.first[a], p[a]);
          box.last[a] = std::max(box.last[a], p[a]);
        }
      }
  return box;
}

GridBox Workspace::largest_box() const {
  GridBox best;
  const auto [nx, ny, nz] = count_;
  // A flat grid along Z is one plane, not many slices of one row.
  if (nz > 1 && (nx == 1 || ny == 1)) {
    const Rectangle r = largest_rectangle(bits_, ny == 1 ? nx : ny, nz);
    if (ny == 1) return {{r.x0, 0, r.y0}, {r.x1, 0, r.y1}};
    return {{0, r.x0, r.y0}, {0, r.x1, r.y1}};
  }
  const std::size_t layer = static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
  for (int k0 = 0; k0 < nz; ++k0) {
    std::vector<unsigned char> all(layer, 1);
    for (int k1 = k0; k1 < nz; ++k1) {
      for (std::size_t n = 0; n < layer; ++n)
        all[n] &= bits_[static_cast<std::size_t>(k1) * layer + n];
      const Rectangle r = largest_rectangle(all, nx, ny);
      const GridBox box{{r.x0, r.y0, k0}, {r.x1, r.y1, k1}};
      if (r.points() > 0 && box.points() > best.points()) best = box;
      if (r.points() == 0) break;
    }
  }
  return best;
}

bool Workspace::keep_connected(const Vec3& p) {
  std::array<int, 3> start{};
  for (int a = 0; a < 3; ++a) {
    const auto n = static_cast<std::size_t>(a);
    start[n] =
        std::clamp(static_cast<int>(std::lround((p[a] - first_[a]) / pitch_)), 0, count_[n] - 1);
  }
  if (!in(start[0], start[1], start[2])) return false;
  std::vector<unsigned char> kept(bits_.size(), 0);
  std::vector<std::array<int, 3>> front = {start};
  kept[at(start[0], start[1], start[2])] = 1;
  while (!front.empty()) {
    const std::array<int, 3> here = front.back();
    front.pop_back();
    for (std::size_t a = 0; a < 3; ++a)
      for (const int step : {-1, 1}) {
        std::array<int, 3> next = here;
        next[a] += step;
        if (next[a] < 0 || next[a] >= count_[a]) continue;
        const std::size_t n = at(next[0], next[1], next[2]);
        if (!bits_[n] || kept[n]) continue;
        kept[n] = 1;
        front.push_back(next);
      }
  }
  bits_ = std::move(kept);
  return true;
}

std::vector<AxisValues> tilts_of_box(double a1, double a2, double b1, double b2) {
  constexpr double step = 5 * std::numbers::pi / 180;
  const auto parts = [&](double from, double to) {
    return to > from ? static_cast<int>(std::ceil((to - from) / step - 1e-9)) : 0;
  };
  const int na = parts(a1, a2), nb = parts(b1, b2);
  std::vector<AxisValues> tilts;
  for (int i = 0; i <= na; ++i)
    for (int j = 0; j <= nb; ++j) {
      AxisValues tilt;
      tilt[Axis::a] = na ? a1 + (a2 - a1) * i / na : a1;
      tilt[Axis::b] = nb ? b1 + (b2 - b1) * j / nb : b1;
      tilts.push_back(tilt);
    }
  return tilts;
}

std::optional<Box3> reach_box(const Machine& machine) {
  Random random(0x776b7370);  // any fixed seed
  Box3 box;
  for (int n = 0; n < 20000; ++n) {
    JointVector q(machine.joint_count());
    for (int j = 0; j < machine.joint_count(); ++j) {
      const Joint& joint = machine.joint(JointId{j});
      const double wide = joint.kind == JointKind::rotary ? std::numbers::pi : 1000;
      q[j] = random.between(std::max(joint.min, -wide), std::min(joint.max, wide));
    }
    machine.kinematics().couple(q);
    if (const auto tip = machine.kinematics().forward(q, {}))
      box.extend(Vec3((*tip)[Axis::x], (*tip)[Axis::y], (*tip)[Axis::z]));
  }
  if (box.isEmpty()) return std::nullopt;
  return box;
}

}  // namespace aircut::machine
