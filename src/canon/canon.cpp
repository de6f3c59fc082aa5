#include "canon/canon.h"

#include <array>

namespace aircut::canon {

namespace {

template <class... T>
constexpr std::array<bool, sizeof...(T)> motions(const std::variant<T...>*) {
  return {(std::is_same_v<T, Rapid> || std::is_same_v<T, LinearFeed> ||
           std::is_same_v<T, ArcFeed> || std::is_same_v<T, SplineFeed> ||
           std::is_same_v<T, SyncFeed> || std::is_same_v<T, Probe>)...};
}

}  // namespace

bool is_motion(const Action& action) {
  static constexpr auto moves = motions(static_cast<const Action*>(nullptr));
  return moves[action.index()];
}

AxisValues end_of(const Action& action, const AxisValues& start) {
  return std::visit(
      [&]<class T>(const T& c) {
        if constexpr (std::is_same_v<T, SplineFeed>) {
          AxisValues end = start;
          if (!c.points.empty()) {
            end[Axis::x] = c.points.back().x;
            end[Axis::y] = c.points.back().y;
          }
          return end;
        } else if constexpr (std::is_same_v<T, SyncFeed>) {
          return c.rigid_tap ? start : c.end;  // a rigid tap comes back
        } else if constexpr (requires { c.end; }) {
          return c.end;
        } else {
          return start;
        }
      },
      action);
}

}  // namespace aircut::canon
