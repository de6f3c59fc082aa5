#include "sim/checks/loose.h"

#include <algorithm>
#include <cmath>

namespace aircut::sim {

namespace {

constexpr std::size_t most_told = 20;

// A shell of the stock's surface and the box that it fills.
struct Shell {
  TriangleMesh mesh;
  Box3 box;
};

// The shells of a closed mesh that look outwards; hollows inside of them are left out.
std::vector<Shell> shells_of(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.vertices.size());
  for (std::size_t i = 0; i < parent.size(); ++i) parent[i] = static_cast<std::uint32_t>(i);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& t : mesh.triangles)
    for (const int corner : {1, 2}) {
      const auto a = root(t[0]), b = root(t[static_cast<std::size_t>(corner)]);
      parent[std::max(a, b)] = std::min(a, b);
    }
  std::map<std::uint32_t, Shell> shells;
  std::vector<std::uint32_t> place(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    Shell& shell = shells[root(static_cast<std::uint32_t>(i))];
    place[i] = static_cast<std::uint32_t>(shell.mesh.vertices.size());
    shell.mesh.vertices.push_back(mesh.vertices[i]);
    shell.box.extend(mesh.vertices[i]);
  }
  for (const auto& t : mesh.triangles) {
    shells[root(t[0])].mesh.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
  }
  std::vector<Shell> out;
  for (auto& [label, shell] : shells)
    if (volume(shell.mesh) > 0) out.push_back(std::move(shell));
  return out;
}

double apart(const Box3& a, const Box3& b) {
  return std::max((a.min() - b.min()).cwiseAbs().maxCoeff(),
                  (a.max() - b.max()).cwiseAbs().maxCoeff());
}

// Does a body that goes with the stock touch it: a fixture, the table?
bool held(const Shell& shell, double reach, const machine::RawStock& raw, const Scene& scene) {
  const collide::CollisionMesh mesh(shell.mesh);
  for (const SceneBody& body : scene.bodies()) {
    if (!body.collision || body.body.role == machine::Role::stock || body.body.link != raw.link)
      continue;
    const auto distance =
        collide::distance(mesh, raw.X_LS, *body.collision, body.body.X_LB, 2 * reach);
    if (!distance.capped && distance.value <= reach) return true;
  }
  return false;
}

std::string size_text(const Box3& box) {
  const Vec3 s = box.sizes();
  return fixed(s.x(), 1) + " × " + fixed(s.y(), 1) + " × " + fixed(s.z(), 1) + " mm";
}

bool contains(const std::vector<stock::Separate>& list, const stock::Separate& piece) {
  return std::any_of(list.begin(), list.end(), [&](const stock::Separate& other) {
    return other.quanta == piece.quanta && apart(other.box, piece.box) < 1e-9;
  });
}

}  // namespace

void LoosePieces::start(const stock::Stock& stock) {
  const double h = stock.pitch();
  least_ = std::max(1.0, 64 * h * h * h);
  // Looking takes some 30 ns for each Z ray, a cut some 10 µs.
  const Vec3 size = stock.box().sizes() / h;
  window_ = static_cast<std::size_t>(std::clamp(size.x() * size.y() / 8, 4096.0, 65536.0));
  known_ = pieces_of(stock);
}

std::vector<stock::Separate> LoosePieces::pieces_of(const stock::Stock& stock) const {
  return stock.pieces(least_);
}

void LoosePieces::add(const Step& step, const stock::Piece& piece) {
  const plan::Segment& segment = step.segment;
  if (steps_.empty() || steps_.back().t0 != segment.t_start ||
      steps_.back().block != segment.command.block) {
    Where where{.span = segment.command.span,
                .block = segment.command.block,
                .t0 = segment.t_start,
                .t1 = segment.t_end(),
                .feed = segment.feed,
                .rpm = segment.spindle_rpm,
                .tool = segment.tool,
                .motion = segment.kind,
                .work_system = segment.work_system,
                .joints = {}};
    if (const auto joints = step.motion.at(step.motion.t1())) where.joints = *joints;
    steps_.push_back(std::move(where));
  }
  pieces_.push_back(piece);
  steps_.back().pieces = pieces_.size();
}

Expected<void> LoosePieces::look(const stock::Stock& stock, const machine::RawStock& raw,
                                 CutTape& tape, const Scene& scene, Findings& out) {
  if (pieces_.empty()) return {};
  const auto now = pieces_of(stock);
  if (now.size() > known_.size() && told_ < most_told) {
    auto before = tape.stock_after(raw, stock.pitch(), done_);
    if (!before) return unexpected(before.error());
    if (auto found = find(std::move(*before), 0, raw, scene, out); !found) return found;
  }
  known_ = now;
  done_ += pieces_.size();
  pieces_.clear();
  steps_.clear();
  return {};
}

Expected<void> LoosePieces::find(stock::Stock stock, std::size_t from, const machine::RawStock& raw,
                                 const Scene& scene, Findings& out) {
  const std::span<const stock::Piece> all(pieces_);
  while (told_ < most_told && from < all.size()) {
    const auto before = pieces_of(stock);
    stock::Stock end = stock.clone();
    if (auto cut = end.cut(all.subspan(from)); !cut) return unexpected(cut.error());
    if (pieces_of(end).size() <= before.size()) return {};
    // In one piece more after `high`, not yet after `low`; `stock` is as after `low`.
    std::size_t low = from, high = all.size();
    while (high - low > 1) {
      const std::size_t middle = low + (high - low) / 2;
      stock::Stock half = stock.clone();
      if (auto cut = half.cut(all.subspan(low, middle - low)); !cut) return unexpected(cut.error());
      if (pieces_of(half).size() > before.size()) {
        high = middle;
      } else {
        low = middle;
        stock = std::move(half);
      }
    }
    const auto just_before = pieces_of(stock);
    if (auto cut = stock.cut(all.subspan(low, 1)); !cut) return unexpected(cut.error());
    tell(stock, low, just_before, pieces_of(stock), raw, scene, out);
    from = high;
  }
  return {};
}

void LoosePieces::tell(const stock::Stock& stock, std::size_t last,
                       const std::vector<stock::Separate>& before,
                       const std::vector<stock::Separate>& now, const machine::RawStock& raw,
                       const Scene& scene, Findings& out) {
  const std::vector<Shell> shells = shells_of(stock.mesh());
  std::vector<const Shell*> shell_of(now.size(), nullptr);
  std::vector<bool> is_held(now.size(), false);
  for (std::size_t i = 0; i < now.size(); ++i) {
    for (const Shell& shell : shells)
      if (!shell_of[i] || apart(shell.box, now[i].box) < apart(shell_of[i]->box, now[i].box))
        shell_of[i] = &shell;
    is_held[i] = shell_of[i] && held(*shell_of[i], stock.pitch(), raw, scene);
  }
  if (std::none_of(is_held.begin(), is_held.end(), [](bool yes) { return yes; })) is_held[0] = true;
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (is_held[i] || contains(before, now[i])) continue;
    ++told_;
    Finding f = row_at(last, scene);
    f.body_a = f.body_b = "stock";
    f.pair = "stock-stock";
    f.quantity = std::to_string(i);
    f.value = now[i].volume;
    f.unit = "mm3";
    f.message =
        "a piece of the stock comes loose: " + fixed(now[i].volume, now[i].volume < 10 ? 2 : 0) +
        " mm³, " + size_text(now[i].box) + ", and nothing holds it";
    f.remedy = "leave tabs, clamp it, or turn it all to chips";
    if (f.joints_worst.size() > 0) {
      machine::LinkPoses poses;
      machine::forward(scene.machine(), f.joints_worst, poses);
      f.points = {poses.X_WL[static_cast<std::size_t>(machine::index(raw.link))] * raw.X_LS *
                  now[i].box.center()};
    }
    out.add(std::move(f));
  }
}

Finding LoosePieces::row_at(std::size_t piece, const Scene& scene) const {
  const auto at = std::find_if(steps_.begin(), steps_.end(),
                               [&](const Where& where) { return where.pieces > piece; });
  const Where& where = at == steps_.end() ? steps_.back() : *at;
  Finding f;
  f.kind = Kind::loose_piece;
  f.severity = severity_of(f.kind);
  f.span = where.span;
  f.block = where.block;
  f.t_block = where.t0;
  f.t_block_end = f.t_first = f.t_worst = f.t_end = where.t1;
  f.u_first = f.u_end = 1;
  f.motion = where.motion;
  f.feed = where.feed;
  f.spindle_rpm = where.rpm;
  f.joints_first = f.joints_worst = where.joints;
  f.tool = where.tool;
  if (const tool::Tool* tool = scene.tools().find(where.tool)) f.tool_name = tool->name;
  f.work_system = work_system_name(where.work_system);
  return f;
}

}  // namespace aircut::sim
