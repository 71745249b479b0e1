// SPDX-License-Identifier: BSD-3-Clause
// ∫ f_mn over the domain of a density that is constant in each cell of a raster. All lengths are
// from the domain's lower left corner.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/basis/basis.h"
#include "target/plane_integrals.h"
#include "target/rectangle.h"
#include "target/trapezoids.h"

namespace ergocast {

/// Equal cells that fill `extent`: cell (column 0, row 0) has its lower left corner. A value
/// belongs to its whole cell, so the centre of the first cell is half a cell inside the extent.
struct RasterGrid {
  Rectangle extent;
  int columns = 0, rows = 0;
};

/// Takes the rows in any order, each once, and stores none of them: O(columns · modes_x) of memory.
/// Exact except for rounding: each cell's integral has a closed form, and a cell that the domain's
/// edge or a keep-out cuts counts by its free part. The sums run in the order of the rows, and of
/// the columns within a row, on every processor.
class RasterIntegral {
 public:
  /// @param size_m  of the domain
  /// @param free    free_area() of the domain
  RasterIntegral(const RasterGrid& grid, const Eigen::Vector2d& size_m, const Basis& basis,
                 std::vector<Trapezoid> free);

  /// @param row     counted from the south, each row once; missing rows are zero
  /// @param values  `columns` densities, at least 0, up to one common factor
  void add_row(int row, std::span<const double> values);

  /// The integral over the whole extent.
  double whole() const { return whole_; }
  /// Whether any value was above 0.
  bool has_mass() const { return whole_ > 0; }

  /// The integrals divided by the integral over the whole extent: entry (0,0) is the free share.
  /// @pre has_mass()
  PlaneIntegrals shares() const;

 private:
  void add_piece(const Trapezoid& piece, std::span<const double> values);
  void add_cut_cell(std::size_t column, const Trapezoid& piece, double value);
  Eigen::VectorXd sum_of(std::span<const double> values, std::size_t begin, std::size_t end) const;

  RasterGrid grid_;
  Eigen::Vector2d size_m_;  // of the domain
  Eigen::Vector2d cell_m_;
  std::vector<double> low_, high_;  // of each column, clipped to the domain
  Eigen::MatrixXd along_x_;         // modes_x, and zeros to a round number, × columns
  std::vector<Trapezoid> free_;
  PlaneCoefficients sums_;
  double whole_ = 0, rounding_ = 0;
};

}  // namespace ergocast
