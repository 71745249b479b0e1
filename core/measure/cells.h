// SPDX-License-Identifier: BSD-3-Clause
// The domain divided into cells of equal size, for measures that are sums over places.
#pragma once

#include <Eigen/Core>
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
};

}  // namespace ergocast
