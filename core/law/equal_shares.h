// SPDX-License-Identifier: BSD-3-Clause
// Divides the cells of a plane into rectangles of equal mass, one for each agent of a team.
#pragma once

#include <cstddef>
#include <vector>

#include "core/measure/cells.h"

namespace ergocast {

/// Cells first … last − 1 along x and y.
struct CellRange {
  int first_i = 0, last_i = 0, first_j = 0, last_j = 0;

  bool operator==(const CellRange&) const = default;
};

/// Sums over ranges of cells in constant time.
class RangeSums {
 public:
  RangeSums() = default;
  /// @param values  one a cell of a plane
  RangeSums(const Cells& cells, const std::vector<double>& values);
  double of(const CellRange& range) const;

 private:
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(i) * rows_ + static_cast<std::size_t>(j);
  }
  double at(int i, int j) const { return below_[index(i, j)]; }

  std::size_t rows_ = 0;
  std::vector<double> below_;  // over the cells before (i, j) along both axes
};

/// The share of agent `rank` of `count`. The domain is halved again and again along its longer
/// side, each time in proportion to the agents on both sides. Shares are whole cells; so they are
/// equal up to a line of cells.
/// @pre 0 <= rank < count
CellRange equal_share(const Cells& cells, const RangeSums& mass, int rank, int count);

}  // namespace ergocast
