// SPDX-License-Identifier: BSD-3-Clause
// Which places of a domain with walls a body can reach from each other while it keeps its
// clearance.
//
// The domain is a grid, usually with 256 cells along its longer side. Two neighbouring cells are
// joined if the straight way between their centres keeps the clearance, which is tested exactly. So
// every way that is found exists. A passage narrower than a cell and twice the clearance may be
// missed.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/geometry.h"
#include "core/base/indexed_rings.h"

namespace ergocast {

class FreeRegion {
 public:
  /// @pre `domain` is planar, and no edges of `walls` touch
  /// @param kept_m  above 0
  FreeRegion(const IndexedRings& walls, const Box& domain, double kept_m, int cells = 256);

  /// The number of parts that no way joins, the largest first. Parts below 1/1000 of the free area
  /// are left out: they are niches that the grid does not resolve.
  int parts() const { return static_cast<int>(sizes_.size()); }
  /// The free share of the domain's area.
  double free_share() const;
  /// The share of a part in the free area.
  double share_of(int part) const;
  /// The part that the cell of `x_m` belongs to; nothing where its centre is not free.
  std::optional<int> part_at(const Eigen::Vector2d& x_m) const;
  /// The centre of the part's cell that is farthest from all walls.
  Eigen::Vector2d middle_m(int part) const;

  int cells() const { return columns_ * rows_; }
  /// The longer side of a cell.
  double cell_size_m() const { return std::max(steps_m_[0], steps_m_[2]); }
  bool is_free(int cell) const { return part_[static_cast<std::size_t>(cell)] >= 0; }
  int cell_at(const Eigen::Vector2d& x_m) const;
  Eigen::Vector2d center_m(int cell) const;
  /// The length of the shortest way along neighbours from the centre of a cell to that of each
  /// cell. It is at most 8 % too long, and infinite where there is no way.
  std::vector<double> ways_m(int from) const;
  /// The same from the nearest of several cells, and only through cells that may be crossed.
  /// @param crossed  for each cell whether it may be; empty: all may
  std::vector<double> ways_m(const std::vector<int>& from, const std::vector<bool>& crossed) const;
  /// Whether a way from one cell to another is at most so long. It takes time only for the cells
  /// that are so near.
  bool has_way(int from, int to, double most_m) const;
  /// The neighbour through which the shortest of these ways leads; the cell itself at the end of
  /// the ways and where there is none. Ways that differ only by rounding are equally short. Among
  /// them the one with the longest first step is taken, so neither the domain's origin nor its axes
  /// decide.
  int nearer(const std::vector<double>& ways_m, int cell) const;
  /// Calls `each(cell)` for the cells of any part that are at most kNiche cells away from `x_m`
  /// along an axis.
  void for_cells_near(const Eigen::Vector2d& x_m, auto&& each) const {
    const int cell = cell_at(x_m), column = cell % columns_, row = cell / columns_;
    for (int r = std::max(0, row - kNiche); r <= std::min(rows_ - 1, row + kNiche); ++r) {
      for (int c = std::max(0, column - kNiche); c <= std::min(columns_ - 1, column + kNiche);
           ++c) {
        const int near = r * columns_ + c;
        if (part_[static_cast<std::size_t>(near)] >= 0) each(near);
      }
    }
  }
  /// The nearest to `x_m` of those cells; nothing if none of them is free.
  std::optional<int> free_cell_near(const Eigen::Vector2d& x_m) const;
  static constexpr int kNiche = 3;

 private:
  void join(const IndexedRings& walls, double kept_m);
  bool joined(const IndexedRings& walls, int from, int to, double kept_m) const;
  /// Calls `each(neighbour, length of the step)` for the neighbours that a cell is joined with.
  void for_joined(int cell, auto&& each) const;
  void grow(int seed, int part);
  void sort_parts();

  Box domain_;
  int columns_ = 1, rows_ = 1;
  std::array<double, 8> steps_m_{};  // to each neighbour: the same from every cell, to the last bit
  std::vector<double> clearance_m_;  // of each cell's centre
  std::vector<std::uint8_t> joins_;  // of each cell, a bit for each neighbour
  std::vector<int> part_;            // of each cell; −1: none
  std::vector<int> sizes_;           // in cells
};

}  // namespace ergocast
