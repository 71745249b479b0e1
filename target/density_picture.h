// SPDX-License-Identifier: BSD-3-Clause
// The target density as a picture for people: averages over the cells of a grid of the domain. All
// lengths are from the domain's lowest corner.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "target/raster_integral.h"
#include "target/target.h"

namespace ergocast {

/// One number for each cell: row i along x, column j along y, both upwards from the domain's
/// corner.
using DensityGrid = Eigen::MatrixXd;

/// Averages over a raster's cells, row by row like RasterIntegral.
class RasterPicture {
 public:
  /// @param size_m  of the domain
  RasterPicture(const RasterGrid& grid, const Eigen::Vector2d& size_m, int cells_x, int cells_y);
  void add_row(int row, std::span<const double> values);

  /// Density [1/m²] of a raster with the mass 1, exact except for rounding.
  DensityGrid density() const;

 private:
  RasterGrid grid_;
  Eigen::Vector2d size_m_;
  DensityGrid mass_;
  double whole_ = 0;
};

/// Σ of the target's parts seen from above, along z added up [1/m²], before the division by its
/// mass. `maps` holds the weighted densities of the maps in each storey. Regions, the shares of
/// cells that keep-outs leave, and Gaussians without correlation are exact. Gaussians with
/// correlation are averages of 4 × 4 points, and of 32 heights a storey if z is correlated.
/// @param size_m  of the domain
DensityGrid density_picture(const TargetDensity& target, std::span<const DensityGrid> maps,
                            const Eigen::Vector3d& size_m);

}  // namespace ergocast
