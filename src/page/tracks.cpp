#include "page/tracks.h"

#include "page/pack.h"

namespace aircut::page {
namespace {

constexpr int last_stage = 12;
constexpr std::size_t most_triangles = 30'000;

}  // namespace

std::vector<LinkTrack> link_tracks(const Replay& replay) {
  const machine::Machine& machine = replay.machine();
  const std::size_t n = machine.links().size();
  std::vector<LinkTrack> out(n);
  std::vector<Eigen::Quaterniond> before(n, Eigen::Quaterniond::Identity());
  machine::LinkPoses poses;
  for (const Replay::Key& key : replay.keys()) {
    machine::forward(machine, key.joints, poses);
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 at = poses.X_WL[i].translation();
      Eigen::Quaterniond turn(poses.X_WL[i].linear());
      if (turn.dot(before[i]) < 0) turn.coeffs() *= -1;  // the nearer of the two that mean the same
      before[i] = turn;
      for (int k = 0; k < 3; ++k) out[i][static_cast<std::size_t>(k)].push_back(at[k]);
      for (int k = 0; k < 4; ++k)
        out[i][static_cast<std::size_t>(3 + k)].push_back(turn.coeffs()[k]);
    }
  }
  return out;
}

Expected<std::vector<StockStage>> stock_stages(const Replay& replay, sim::StockHistory* history) {
  std::vector<StockStage> out;
  for (int i = 0; history && i <= last_stage; ++i) {
    const double t = replay.keys().back().t * i / last_stage;
    const auto mesh = history->at(t);
    if (!mesh) return unexpected(mesh.error());
    out.push_back({t, at_most(**mesh, most_triangles)});
  }
  return out;
}

}  // namespace aircut::page
