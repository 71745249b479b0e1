// SPDX-License-Identifier: BSD-3-Clause
// Adds up the cosines axis by axis, and finds the cells in walls by one sorted list of crossings a
// column.
#include "core/measure/target_mass.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/base/ordered_product.h"
#include "core/base/portable_math.h"

namespace ergocast {
namespace {

using Table = Eigen::MatrixXd;  // cells × modes

/// cos(mπ s/L) / mean(cos²) at the middles of the cells of an axis.
Table cosines(int cells, int modes) {
  Table table(cells, modes);
  for (int cell = 0; cell < cells; ++cell) {
    for (int m = 0; m < modes; ++m)
      table(cell, m) =
          (m == 0 ? 1 : 2) * portable::cos(m * std::numbers::pi * (cell + 0.5) / cells);
  }
  return table;
}

/// max(0, V p) at the middle of each cell.
std::vector<double> densities(const Basis& basis, const Coefficients& target, const Cells& cells) {
  const Table along_x = cosines(cells.count.x(), basis.modes_x);
  const Table along_y = cosines(cells.count.y(), basis.modes_y);
  const Table along_z = cosines(cells.count.z(), basis.modes_z);
  const int in_layer = basis.modes_x * basis.modes_y;
  std::vector<double> density(cells.total());
  for (int l = 0; l < cells.count.z(); ++l) {
    PlaneCoefficients layer = PlaneCoefficients::Zero(basis.modes_x, basis.modes_y);
    for (int mode = 0; mode < basis.modes_z; ++mode) {
      const Eigen::Map<const PlaneCoefficients> modes(target.data() + mode * in_layer,
                                                      basis.modes_x, basis.modes_y);
      layer += along_z(l, mode) * modes;
    }
    Eigen::Map<PlaneCoefficients>(density.data() + cells.column(0, l), cells.count.x(),
                                  cells.count.y()) =
        ordered_product(ordered_product(along_x, layer), along_y.transpose()).cwiseMax(0);
  }
  return density;
}

/// Takes the mass out of the cells whose middles are in walls, in a plane.
void empty_walls(const Rings& walls, const Cells& cells, std::vector<double>& mass) {
  for (int i = 0; i < cells.count.x(); ++i) {
    const std::vector<double> crossings = crossings_m(walls, 0, cells.center_m(0, i));
    std::size_t passed = 0;
    for (int j = 0; j < cells.count.y(); ++j) {
      while (passed < crossings.size() && crossings[passed] < cells.center_m(1, j)) ++passed;
      if (passed % 2 == 1) mass[cells.column(i, 0) + static_cast<std::size_t>(j)] = 0;
    }
  }
}

}  // namespace

std::vector<double> target_mass(const Basis& basis, const Rings& walls, const Coefficients& target,
                                const Cells& cells) {
  std::vector<double> mass = densities(basis, target, cells);
  if (!walls.empty() && cells.domain.planar()) empty_walls(walls, cells, mass);
  const double total = std::accumulate(mass.begin(), mass.end(), 0.0);
  if (!(total > 0) || !std::isfinite(total)) return std::vector<double>(mass.size(), 0);
  for (double& cell : mass) cell /= total;
  return mass;
}

}  // namespace ergocast
