// SPDX-License-Identifier: BSD-3-Clause
// Chooses the counts of cells, and looks places up.
#include "core/measure/cells.h"

#include <algorithm>
#include <cmath>

#include "core/base/require.h"

namespace ergocast {
namespace {

/// By how much sides grow until there are few enough cells.
constexpr double kGrowth = 1.05;

/// How many sides of `side_m` an axis has, not yet rounded.
Eigen::Array3d sides(const Box& domain, double side_m) {
  return (domain.size_m.array() / side_m).max(1);
}

}  // namespace

Cells::Cells(const Box& box, double side_m) : domain(box) {
  ERGOCAST_REQUIRE(side_m > 0);
  while (sides(domain, side_m).ceil().prod() > static_cast<double>(kMaxMeasureCells))
    side_m *= kGrowth;
  count = sides(domain, side_m).ceil().cast<int>();
  size_m = domain.size_m.array() / count.cast<double>();
}

std::size_t Cells::cell_of(const Eigen::Vector3d& x_m) const {
  Eigen::Array3i at{0, 0, 0};
  for (int axis = 0; axis < 3; ++axis) {
    if (count[axis] == 1) continue;
    const double cells = (x_m[axis] - domain.origin_m[axis]) / size_m[axis];
    at[axis] = std::clamp(static_cast<int>(std::floor(cells)), 0, count[axis] - 1);
  }
  return column(at.x(), at.z()) + static_cast<std::size_t>(at.y());
}

Cells::Range Cells::near(int axis, double at_m, double reach_m) const {
  if (count[axis] == 1) return {0, 0};
  const double middle = (at_m - domain.origin_m[axis]) / size_m[axis] - 0.5;
  const double half = reach_m / size_m[axis], last = count[axis] - 1;
  return {static_cast<int>(std::clamp(std::ceil(middle - half), 0.0, last + 1)),
          static_cast<int>(std::clamp(std::floor(middle + half), -1.0, last))};
}

}  // namespace ergocast
