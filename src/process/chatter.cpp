// Turned: the chip's width b = t / sin κ is compared with the limit that holds at every speed; the
// whole cutting force counts as if it lay along the mode, which is safe. Milled: the limit at the
// cut's own speed, for its engaged angles. Those are rounded outwards to a fiftieth of a radian, so
// that a program has few of them: each one takes thousands of frequencies to find.
#include "process/chatter.h"

#include <cmath>
#include <numbers>

namespace aircut::process {

using namespace accuracy;

namespace {

constexpr double warned = 0.9;  // of the limit
constexpr double angle = 0.02;  // rad

}  // namespace

std::optional<double> Chatter::limit(const Engaged& engaged, const Mode& mode) {
  const CutContact& contact = engaged.contact;
  if (engaged.cut->turned) {
    const double P = contact.cut_law.at(contact.t, contact.S, contact.V);
    if (!(P > 0)) return std::nullopt;
    const double sine = contact.chip / contact.S;
    return turning_limit(mode, P / (contact.t * contact.S)) * sine;
  }
  const Cutter* cutter = engaged.cutter;
  if (!cutter || !contact.engaged || !(contact.K_t > 0)) return std::nullopt;
  const double start = std::floor(contact.engaged->start / angle);
  const double exit = std::ceil(contact.engaged->exit / angle);
  const double rpm = std::abs(engaged.cut->rpm);
  const std::array<long, 5> key = {static_cast<long>(engaged.tool), std::lround(start),
                                   std::lround(exit), std::lround(rpm), std::lround(contact.K_t)};
  const auto [found, is_new] = limits_.try_emplace(key);
  if (is_new)
    found->second = milling_depth_limit(
        cutter->teeth, {std::max(start * angle, 0.0), std::min(exit * angle, std::numbers::pi)},
        contact.K_t, contact.K_r, mode, rpm);
  return found->second;
}

void Chatter::look(const Engaged& engaged) {
  const auto& mode =
      setup_.tools[engaged.tool].mode ? setup_.tools[engaged.tool].mode : setup_.mode;
  if (!mode || !(engaged.contact.t > 0)) return;
  const auto most = limit(engaged, *mode);
  if (!most || engaged.contact.t <= warned * *most) return;
  WorstCut& worst = worst_[engaged.tool];
  ++worst.count;
  if (worst.limit > 0 && engaged.contact.t / *most <= worst.depth / worst.limit) return;
  const std::size_t count = worst.count;
  worst = {engaged.contact.t, *most, std::abs(engaged.cut->rpm),   engaged.cut->t0,
           engaged.cut->span, count, engaged.cut->turned ? 0u : 1u};
}

void Chatter::finish(Diagnostics& out) const {
  for (std::size_t i = 0; i < worst_.size(); ++i) {
    const WorstCut& worst = worst_[i];
    if (worst.count == 0) continue;
    Diagnostic d =
        make_error("chatter_risk", worst.span,
                   "T" + std::to_string(setup_.tools[i].id) + " cuts " + fixed(worst.depth, 2) +
                       " mm deep; it chatters from " + fixed(worst.limit, 2) + " mm on" +
                       (worst.milled ? " at " + fixed(worst.rpm, 0) + " rpm" : ", at some speeds"));
    d.severity = Severity::warning;
    d.notes.push_back({"note", "t = " + fixed(worst.t, 3) + " s; " + std::to_string(worst.count) +
                                   " stretches are as deep as nine tenths of their limit"});
    out.add(std::move(d));
  }
}

}  // namespace aircut::process
