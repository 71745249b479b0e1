// SPDX-License-Identifier: BSD-3-Clause
// Evaluates densities in the middle of each cell, and averages what is missed over it.
#include "core/measure/occupancy.h"

#include <algorithm>
#include <cmath>

namespace ergocast {
namespace {

/// A density at places; for a box, averaged along z, which leaves the modes l = 0.
class PlaneDensity {
 public:
  PlaneDensity(const Coefficients& coefficients, const Mission& mission)
      : domain_(mission.domain), basis_(mission.basis) {
    basis_.modes_z = 1;
    scaled_ = coefficients.head(basis_.mode_count());
    auto weights = in_plane(scaled_, basis_);
    weights.bottomRows(weights.rows() - 1) *= 2;  // mean(cos²) = ½ along each axis that varies
    weights.rightCols(weights.cols() - 1) *= 2;
  }
  double at(const Eigen::Vector3d& x_m) const {
    return basis_values(x_m, domain_, basis_).dot(scaled_);
  }

 private:
  Box domain_;
  Basis basis_;
  Coefficients scaled_;
};

OccupancyGrid empty_grid(const Box& domain) {
  OccupancyGrid grid;
  grid.resolution_m = domain.size_m.head<2>().maxCoeff() / kOccupancyCells;
  const auto cells = [&](double side_m) {
    const double count = std::ceil(side_m / grid.resolution_m - 1e-9);
    return static_cast<std::uint32_t>(std::clamp(count, 1.0, double{kOccupancyCells}));
  };
  grid.width = cells(domain.size_m.x());
  grid.height = cells(domain.size_m.y());
  return grid;
}

Eigen::Vector3d middle_m(const OccupancyGrid& grid, std::size_t cell, const Box& domain) {
  const std::size_t column = cell % grid.width, row = cell / grid.width;
  return domain.origin_m + grid.resolution_m * Eigen::Vector3d(static_cast<double>(column) + 0.5,
                                                               static_cast<double>(row) + 0.5, 0);
}

}  // namespace

OccupancyGrid occupancy_of(const Coefficients& coefficients, const Coefficients& target,
                           const Mission& mission) {
  const Box& domain = mission.domain;
  const PlaneDensity density(coefficients, mission), scale(target, mission);
  OccupancyGrid grid = empty_grid(domain);
  std::vector<double> values(std::size_t{grid.width} * grid.height, -1);
  double greatest = 0;
  for (std::size_t cell = 0; cell < values.size(); ++cell) {
    const Eigen::Vector3d x_m = middle_m(grid, cell, domain);
    if (!domain.contains(x_m)) continue;
    values[cell] = std::max(0.0, density.at(x_m));
    greatest = std::max(greatest, scale.at(x_m));
  }
  for (const double value : values)
    grid.data.push_back(static_cast<std::int8_t>(
        value < 0 ? -1 : std::lround(std::min(100.0, 100 * value / std::max(greatest, 1e-12)))));
  return grid;
}

/// What is missed in a cell of the grid is the mean over the cells of the measure in it, by their
/// mass. Where none has its middle in it, that of the cell around the grid's middle counts.
OccupancyGrid occupancy_left(const Detection& detection, const Coefficients& target,
                             const Mission& mission) {
  OccupancyGrid grid = occupancy_of(target, target, mission);
  const Cells& cells = detection.cells();
  const auto index = [&](int axis, int at, std::uint32_t count) {
    const double off_m = cells.center_m(axis, at) - mission.domain.origin_m[axis];
    return std::min(static_cast<std::uint32_t>(off_m / grid.resolution_m), count - 1);
  };
  std::vector<double> mass(grid.data.size(), 0), missed(grid.data.size(), 0);
  for (int l = 0; l < cells.count.z(); ++l) {
    for (int i = 0; i < cells.count.x(); ++i) {
      const std::uint32_t column = index(0, i, grid.width);
      for (int j = 0; j < cells.count.y(); ++j) {
        const std::size_t from = cells.column(i, l) + static_cast<std::size_t>(j);
        const std::size_t to = std::size_t{index(1, j, grid.height)} * grid.width + column;
        mass[to] += detection.mass()[from];
        missed[to] += detection.mass()[from] * detection.missed()[from];
      }
    }
  }
  for (std::size_t to = 0; to < grid.data.size(); ++to) {
    if (grid.data[to] <= 0) continue;
    const double share =
        mass[to] > 0 ? missed[to] / mass[to]
                     : detection.missed()[cells.cell_of(middle_m(grid, to, mission.domain))];
    grid.data[to] = static_cast<std::int8_t>(std::lround(share * grid.data[to]));
  }
  return grid;
}

}  // namespace ergocast
