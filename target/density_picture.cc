// SPDX-License-Identifier: BSD-3-Clause
// Distributes each part of the density over the cells of a grid by the area that they share.
#include "target/density_picture.h"

#include <algorithm>
#include <cmath>

#include "core/base/portable_math.h"
#include "target/leaning_gaussian.h"
#include "target/trapezoids.h"

namespace ergocast {
namespace {

/// Calls `visit(cell, length)` for every cell of [0, size] that [low, high] overlaps.
template <class Visit>
void for_each_overlap(double low, double high, double size, Eigen::Index cells,
                      const Visit& visit) {
  const double cell = size / static_cast<double>(cells);
  low = std::max(low, 0.0);
  high = std::min(high, size);
  for (auto i = static_cast<Eigen::Index>(low / cell); i < cells; ++i) {
    const double from = static_cast<double>(i) * cell;
    if (from >= high) return;
    const double length = std::min(high, from + cell) - std::max(low, from);
    if (length > 0) visit(i, length);
  }
}

/// ∫ max(0, s) along a height, where s changes linearly from `low` to `high`.
double positive_part(double low, double high, double height) {
  const auto [least, most] = std::minmax(low, high);
  if (most <= 0) return 0;
  if (least >= 0) return height * 0.5 * (least + most);
  return height * most * most / (2 * (most - least));
}

/// The area of the part of `piece` to the left of a vertical.
double area_left_of(double x, const Trapezoid& piece) {
  const double height = piece.high - piece.low;
  return positive_part(x - piece.left_low, x - piece.left_high, height) -
         positive_part(x - piece.right_low, x - piece.right_high, height);
}

/// Adds the share of each cell of a row of cells that `piece`, which is in this row, covers.
void add_shares(const Trapezoid& piece, const Eigen::Vector2d& cell_m,
                Eigen::Ref<Eigen::VectorXd> row) {
  const double left = std::max(0.0, std::min(piece.left_low, piece.left_high));
  const double right = std::max(piece.right_low, piece.right_high);
  double before = 0;
  for (auto i = static_cast<Eigen::Index>(left / cell_m.x()); i < row.size(); ++i) {
    const double from = static_cast<double>(i) * cell_m.x();
    if (from >= right) return;
    const double area = area_left_of(static_cast<double>(i + 1) * cell_m.x(), piece);
    row[i] += (area - before) / cell_m.prod();
    before = area;
  }
}

/// The share of each cell that `pieces` cover; exactly 0 where rounding alone leaves anything.
DensityGrid shares_of(const std::vector<Trapezoid>& pieces, const Eigen::Vector2d& size_m,
                      const DensityGrid& like) {
  const Eigen::Vector2d cell_m(size_m.x() / static_cast<double>(like.rows()),
                               size_m.y() / static_cast<double>(like.cols()));
  DensityGrid shares = DensityGrid::Zero(like.rows(), like.cols());
  for (const Trapezoid& piece : pieces) {
    for_each_overlap(piece.low, piece.high, size_m.y(), like.cols(), [&](Eigen::Index j, double) {
      const double low = static_cast<double>(j) * cell_m.y();
      const Trapezoid part =
          piece.between(std::max(piece.low, low), std::min(piece.high, low + cell_m.y()));
      add_shares(part, cell_m, shares.col(j));
    });
  }
  return (shares.array() < 1e-12).select(0, shares);
}

/// The averages of a one-dimensional Gaussian density over `cells` equal parts of [0, size].
Eigen::VectorXd averages_along(double mean, double deviation, double size, Eigen::Index cells) {
  const double cell = size / static_cast<double>(cells);
  const auto below = [&](Eigen::Index i) {
    return 0.5 * portable::erf((static_cast<double>(i) * cell - mean) / (deviation * std::sqrt(2)));
  };
  Eigen::VectorXd averages(cells);
  for (Eigen::Index i = 0; i < cells; ++i) averages[i] = (below(i + 1) - below(i)) / cell;
  return averages;
}

void add_separable(double weight, const PlaneGaussian& gaussian, const Eigen::Vector2d& size_m,
                   DensityGrid& sum) {
  const Eigen::Vector2d& mean_m = gaussian.mean_m;
  const Eigen::Vector2d deviation_m = gaussian.covariance_m2.diagonal().cwiseSqrt();
  sum += weight * averages_along(mean_m.x(), deviation_m.x(), size_m.x(), sum.rows()) *
         averages_along(mean_m.y(), deviation_m.y(), size_m.y(), sum.cols()).transpose();
}

/// A Gaussian with correlation, averaged over 4 × 4 points of each cell.
void add_correlated(double weight, const PlaneGaussian& gaussian, const Eigen::Vector2d& size_m,
                    DensityGrid& sum) {
  constexpr int kPoints = 4;
  const Eigen::Vector2d step(size_m.x() / static_cast<double>(kPoints * sum.rows()),
                             size_m.y() / static_cast<double>(kPoints * sum.cols()));
  const GaussianDensity density(gaussian);
  const double share = weight / (kPoints * kPoints);
  for (Eigen::Index j = 0; j < kPoints * sum.cols(); ++j) {
    for (Eigen::Index i = 0; i < kPoints * sum.rows(); ++i) {
      const Eigen::Vector2d point(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5);
      sum(i / kPoints, j / kPoints) += share * density(step.cwiseProduct(point));
    }
  }
}

void add_plane(double weight, const PlaneGaussian& gaussian, const Eigen::Vector2d& size_m,
               DensityGrid& sum) {
  if (gaussian.covariance_m2(0, 1) == 0) {
    add_separable(weight, gaussian, size_m, sum);
  } else {
    add_correlated(weight, gaussian, size_m, sum);
  }
}

/// Adds the part of a Gaussian between two heights.
void add_gaussian(const Gaussian& gaussian, const Heights& between, const Eigen::Vector3d& size_m,
                  DensityGrid& sum) {
  constexpr int kHeights = 32;
  const GaussianAtHeight g(gaussian);
  const AlongZ along_z(size_m.z(), Basis{});
  const bool leans = size_m.z() > 0 && g.leans();
  const int slices = leans ? kHeights : 1;
  const double slice_m = between.length_m() / slices;
  for (int i = 0; i < slices; ++i) {
    const double low_m = between.low_m + i * slice_m;
    const double share =
        along_z.gaussian(g.mean_z_m(), g.deviation_z_m(), {low_m, low_m + slice_m})[0];
    const double seen_at_m = leans ? low_m + 0.5 * slice_m : g.mean_z_m();
    add_plane(gaussian.weight * share, g.at(seen_at_m), size_m.head<2>(), sum);
  }
}

/// All parts between the heights of a storey, added to its maps.
DensityGrid picture_of(const TargetDensity& target, const Storey& storey, DensityGrid sum,
                       const Eigen::Vector3d& size_m) {
  const Eigen::Vector2d base_m = size_m.head<2>();
  const AlongZ along_z(size_m.z(), Basis{});
  sum.array() +=
      along_z.uniform({0, size_m.z()}, storey.heights)[0] * target.uniform_weight / base_m.prod();
  for (const Gaussian& gaussian : target.gaussians)
    add_gaussian(gaussian, storey.heights, size_m, sum);
  if (!storey.keep_outs.empty())
    sum = sum.cwiseProduct(shares_of(storey.free(base_m), base_m, sum)).eval();
  for (const Region& region : target.regions) {
    const double share = along_z.uniform(region.heights, storey.heights)[0];
    sum += share * region.weight / area_m2(region.polygon) *
           shares_of(free_area_within(region.polygon, base_m, storey.keep_outs), base_m, sum);
  }
  return sum;
}

}  // namespace

RasterPicture::RasterPicture(const RasterGrid& grid, const Eigen::Vector2d& size_m, int cells_x,
                             int cells_y)
    : grid_(grid), size_m_(size_m), mass_(DensityGrid::Zero(cells_x, cells_y)) {}

void RasterPicture::add_row(int row, std::span<const double> values) {
  const Eigen::Vector2d cell_m(grid_.extent.size_m.x() / grid_.columns,
                               grid_.extent.size_m.y() / grid_.rows);
  const Eigen::Vector2d low = grid_.extent.origin_m;
  Eigen::VectorXd along = Eigen::VectorXd::Zero(mass_.rows());
  for (int column = 0; column < grid_.columns; ++column) {
    const double value = values[static_cast<std::size_t>(column)];
    if (value == 0) continue;
    whole_ += value * cell_m.x() * cell_m.y();
    for_each_overlap(low.x() + column * cell_m.x(), low.x() + (column + 1) * cell_m.x(),
                     size_m_.x(), mass_.rows(),
                     [&](Eigen::Index i, double length) { along[i] += value * length; });
  }
  for_each_overlap(low.y() + row * cell_m.y(), low.y() + (row + 1) * cell_m.y(), size_m_.y(),
                   mass_.cols(),
                   [&](Eigen::Index j, double length) { mass_.col(j) += length * along; });
}

DensityGrid RasterPicture::density() const {
  const double cells = static_cast<double>(mass_.size());
  return mass_ * (cells / (size_m_.x() * size_m_.y() * whole_));
}

DensityGrid density_picture(const TargetDensity& target, std::span<const DensityGrid> maps,
                            const Eigen::Vector3d& size_m) {
  DensityGrid sum = DensityGrid::Zero(maps[0].rows(), maps[0].cols());
  const std::vector<Storey> storeys = storeys_of(size_m.z(), target.keep_outs);
  for (std::size_t i = 0; i < storeys.size(); ++i)
    sum += picture_of(target, storeys[i], maps[i], size_m);
  return sum;
}

}  // namespace ergocast
