// SPDX-License-Identifier: BSD-3-Clause
// Compares ways on a grid with straight lines, from some places of the target to all others.
#include "scenario/rules/hidden_mass.h"

#include <algorithm>
#include <vector>

#include "core/motion/free_region.h"
#include "core/motion/walls.h"

namespace ergocast {
namespace {

constexpr int kCells = 128;
/// The number of places of the target from which ways begin; each represents the same mass.
constexpr int kSources = 24;

double widest_kept_m(const Mission& mission) {
  double kept_m = 0;
  for (int kind = 0; kind < std::max<int>(1, static_cast<int>(mission.kinds.size())); ++kind)
    kept_m = std::max(kept_m, kept_from_walls_m(mission, motion_of_kind(mission, kind)));
  return kept_m;
}

/// The mass in each free cell of the region.
std::vector<double> masses(const FreeRegion& region, const Box& domain,
                           const DensityGrid& density) {
  std::vector<double> mass(static_cast<std::size_t>(region.cells()), 0);
  const Eigen::Array2d counts(static_cast<double>(density.rows()),
                              static_cast<double>(density.cols()));
  for (Eigen::Index row = 0; row < density.cols(); ++row) {
    for (Eigen::Index column = 0; column < density.rows(); ++column) {
      const Eigen::Array2d middle(static_cast<double>(column) + 0.5,
                                  static_cast<double>(row) + 0.5);
      const Eigen::Vector2d x_m =
          domain.origin_m.head<2>() + (middle / counts * domain.size_m.head<2>().array()).matrix();
      if (region.part_at(x_m))
        mass[static_cast<std::size_t>(region.cell_at(x_m))] += density(column, row);
    }
  }
  return mass;
}

/// The part of `mass` to which the way from a cell is a detour.
double hidden_from(const FreeRegion& region, const std::vector<double>& mass, int source) {
  const std::vector<double> ways_m = region.ways_m(source);
  const Eigen::Vector2d here_m = region.center_m(source);
  double hidden = 0;
  for (int cell = 0; cell < region.cells(); ++cell) {
    const auto i = static_cast<std::size_t>(cell);
    if (ways_m[i] > kDetour * (region.center_m(cell) - here_m).norm()) hidden += mass[i];
  }
  return hidden;
}

}  // namespace

double hidden_share(const Mission& mission, const DensityGrid& density) {
  const FreeRegion region(mission.walls, mission.domain, widest_kept_m(mission), kCells);
  const std::vector<double> mass = masses(region, mission.domain, density);
  double all = 0, hidden = 0, passed = 0;
  for (const double one : mass) all += one;
  int sources = 0;
  for (int cell = 0; cell < region.cells(); ++cell) {
    passed += mass[static_cast<std::size_t>(cell)];
    const bool due = sources < kSources && passed >= (sources + 0.5) / kSources * all;
    if (!due) continue;
    ++sources;
    hidden += hidden_from(region, mass, cell) / all;
  }
  return sources == 0 ? 0 : hidden / sources;
}

}  // namespace ergocast
