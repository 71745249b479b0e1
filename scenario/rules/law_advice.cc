// SPDX-License-Identifier: BSD-3-Clause
// Measures how even a target is, and how much of it a team can pass over.
#include "scenario/rules/law_advice.h"

#include <cmath>

#include "core/measure/detection.h"
#include "core/mission/kinds.h"

namespace ergocast {
namespace {

/// A target that is spread over more than this share has no peaks that are worth the way.
constexpr double kEven = 0.8;
/// From this many passes on, lanes find no more than a search does, also in an even target: with
/// 1.8, 2.4 and 3.3 passes lanes found 0.930, 0.974 and 0.991, a search 0.917, 0.969 and 0.994.
constexpr double kPassesForSearch = 2.5;
/// Lanes lose to a search where the target is spread over less than this share.
constexpr double kPeaked = 0.5;

}  // namespace

double spread_share(const DensityGrid& density) {
  const double mass = density.sum();
  double entropy = 0;
  for (const double cell : density.reshaped()) {
    const double share = cell / mass;
    if (share > 0) entropy -= share * std::log(share);
  }
  return std::exp(entropy) / static_cast<double>(density.size());
}

double passes(const Mission& mission, double spread_share) {
  double speed_mps = 0;
  for (AgentId agent = 0; agent < std::ssize(mission.starts_m); ++agent)
    speed_mps += law_of(mission, planned_kind(mission, agent)).u_max_mps;
  const double seen_m2 = speed_mps * static_cast<double>(mission.timing.tick_count) *
                         mission.timing.dt_s * 2 * sensor_radius_m(mission);
  return seen_m2 / (spread_share * mission.domain.content());
}

LawKind advised_law(const Mission& mission, const DensityGrid& density) {
  const LawKind own = mission.law.kind;
  if (own == LawKind::kCover || !mission.domain.planar()) return own;
  const double spread = spread_share(density);
  const bool lanes = spread > kEven && passes(mission, spread) < kPassesForSearch;
  if (lanes) return LawKind::kMow;
  return spread < kPeaked ? LawKind::kSearch : own;
}

}  // namespace ergocast
