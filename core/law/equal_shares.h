// SPDX-License-Identifier: BSD-3-Clause
// Divides the cells of a domain into boxes of equal mass, one for each agent of a team. In a plane
// they are rectangles.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "core/measure/cells.h"

namespace ergocast {

/// Cells first … last − 1 along each axis.
struct CellRange {
  Eigen::Array3i first{0, 0, 0}, last{0, 0, 0};

  Eigen::Array3i counts() const { return last - first; }
};

/// The axis along which a range of several cells is longest; the first of equal ones.
int longest_axis(const Cells& cells, const CellRange& range);

/// Sums over ranges of cells in constant time.
class RangeSums {
 public:
  RangeSums() = default;
  /// @param values  one a cell
  RangeSums(const Cells& cells, const std::vector<double>& values);
  double of(const CellRange& range) const;

 private:
  std::size_t index(int i, int j, int l) const {
    return (static_cast<std::size_t>(l) * columns_ + static_cast<std::size_t>(i)) * rows_ +
           static_cast<std::size_t>(j);
  }
  double in_plane(const CellRange& range, int l) const;

  std::size_t columns_ = 0, rows_ = 0;
  std::vector<double> below_;  // over the cells before (i, j, l) along all axes
};

/// The share of agent `rank` of `count`. The domain is halved again and again along its longest
/// side, each time in proportion to the agents on both sides. Shares are whole cells; so they are
/// equal up to a layer of cells.
/// @pre 0 <= rank < count
CellRange equal_share(const Cells& cells, const RangeSums& mass, int rank, int count);

}  // namespace ergocast
