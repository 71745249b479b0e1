// SPDX-License-Identifier: BSD-3-Clause
// The domain divided into cells of equal size, for measures that are sums over places.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>

#include "core/base/geometry.h"

namespace ergocast {

/// Limit (Team): cells over which measures are computed. Beyond it: cells are larger than a third
/// of the sensor's radius.
inline constexpr std::size_t kMaxMeasureCells = std::size_t{1} << 17;

/// Cell (i, j, l) along x, y and z has the number (l · count.x + i) · count.y + j. A plane has one
/// cell along z.
struct Cells {
  Box domain;
  Eigen::Array3i count{1, 1, 1};
  Eigen::Vector3d size_m{1, 1, 0};  ///< of a cell

  Cells() = default;
  /// Cells with sides of about `side_m`, or larger ones if these would be more than
  /// kMaxMeasureCells.
  /// @pre side_m > 0, and a domain with a content
  Cells(const Box& domain, double side_m);

  std::size_t total() const {
    return static_cast<std::size_t>(count.x()) * static_cast<std::size_t>(count.y()) *
           static_cast<std::size_t>(count.z());
  }
  /// The number of the cell (0, …) of a column along y.
  std::size_t column(int i, int l) const {
    return (static_cast<std::size_t>(l) * static_cast<std::size_t>(count.x()) +
            static_cast<std::size_t>(i)) *
           static_cast<std::size_t>(count.y());
  }
  /// The middle of a cell along an axis [m].
  double center_m(int axis, int index) const {
    return domain.origin_m[axis] + (index + 0.5) * size_m[axis];
  }
  /// The cell that contains `x_m`. @pre x_m is in the domain
  std::size_t cell_of(const Eigen::Vector3d& x_m) const;

  struct Range {
    int first, last;  ///< none if last < first
  };
  /// The cells along an axis whose middles are at most `reach_m` from `at_m`.
  Range near(int axis, double at_m, double reach_m) const;
  /// Calls each(i, j, l) for the cells whose middles are at most `reach_m` from `x_m`.
  void for_near(const Eigen::Vector3d& x_m, double reach_m, auto&& each) const {
    const Range layers = near(2, x_m.z(), reach_m), columns = near(0, x_m.x(), reach_m);
    for (int l = layers.first; l <= layers.last; ++l) {
      const double up_m = domain.planar() ? 0 : center_m(2, l) - x_m.z();
      for (int i = columns.first; i <= columns.last; ++i) {
        const double off_m = center_m(0, i) - x_m.x();
        const double left_m2 = reach_m * reach_m - off_m * off_m - up_m * up_m;
        if (left_m2 < 0) continue;
        const Range rows = near(1, x_m.y(), std::sqrt(left_m2));
        for (int j = rows.first; j <= rows.last; ++j) each(i, j, l);
      }
    }
  }
};

}  // namespace ergocast
