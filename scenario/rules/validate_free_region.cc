// SPDX-License-Identifier: BSD-3-Clause
// Looks for parts of the domain that walls cut off, for the clearance of each kind's vehicles.
#include <algorithm>
#include <set>

#include "core/motion/free_region.h"
#include "core/motion/walls.h"
#include "scenario/parse/convert.h"
#include "scenario/rules/validate_walls.h"

namespace ergocast {
namespace {

/// Limit (Scenario): share of the domain that walls leave free, at least. Below it: the scenario is
/// refused.
constexpr double kLeastFreeShare = 0.05;

std::string percent(double share) { return shortest(rounded_up(100 * share)) + " %"; }

/// The target's mass in a part of the free region.
double mass_in(const FreeRegion& region, int part, const Box& domain, const DensityGrid& density) {
  double sum = 0;
  for (Eigen::Index row = 0; row < density.cols(); ++row) {
    for (Eigen::Index column = 0; column < density.rows(); ++column) {
      const Eigen::Array2d share(
          (static_cast<double>(column) + 0.5) / static_cast<double>(density.rows()),
          (static_cast<double>(row) + 0.5) / static_cast<double>(density.cols()));
      const Eigen::Vector2d x_m =
          domain.origin_m.head<2>() + (share * domain.size_m.head<2>().array()).matrix();
      if (region.part_at(x_m) == part) sum += density(column, row);
    }
  }
  return sum / density.sum();
}

void cut_off(const Mission& mission, double kept_m, const DensityGrid& density, Checks& checks) {
  const FreeRegion region(mission.walls, mission.domain, kept_m);
  if (region.free_share() < kLeastFreeShare) {
    return checks.problem(
        "world.walls",
        "leave only " + percent(region.free_share()) + " of the domain free, below the limit 5 %",
        "write smaller walls, a smaller wall_clearance_m or a smaller domain");
  }
  if (region.parts() == 1) return;
  const Eigen::Vector2d middle_m = region.middle_m(1);
  checks.problem("world.walls",
                 "cut the free domain in " + std::to_string(region.parts()) +
                     " parts: the one around x " + shortest(middle_m.x()) + ", y " +
                     shortest(middle_m.y()) + " m, " + percent(region.share_of(1)) +
                     " of all that is free and " +
                     percent(mass_in(region, 1, mission.domain, density)) +
                     " of the target, cannot be reached from the largest",
                 "open a passage wider than " +
                     shortest(rounded_up(2 * kept_m + mission.domain.size_m.maxCoeff() / 256)) +
                     " m, or close the part: leave out its hole");
}

}  // namespace

void validate_free_region(const Mission& mission, const DensityGrid& density, Checks& checks) {
  if (mission.walls.empty()) return;
  std::set<double> kept;
  for (int kind = 0; kind < std::max<int>(1, static_cast<int>(mission.kinds.size())); ++kind)
    kept.insert(kept_from_walls_m(mission, motion_of_kind(mission, kind)));
  for (const double kept_m : kept) {
    if (checks.nothing_found()) cut_off(mission, kept_m, density, checks);
  }
}

}  // namespace ergocast
