// SPDX-License-Identifier: BSD-3-Clause
// Distributes each part of the density over the cells of a grid by the area that they share.
#include "target/density_picture.h"

#include <algorithm>
#include <cmath>

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

/// The share of each cell that `pieces` cover.
DensityGrid shares_of(const std::vector<Trapezoid>& pieces, const Rectangle& domain,
                      const DensityGrid& like) {
  constexpr int kLines = 8;
  DensityGrid shares = DensityGrid::Zero(like.rows(), like.cols());
  const double cell_x = domain.size_m.x() / static_cast<double>(like.rows());
  const auto lines = static_cast<double>(kLines * like.cols());
  for (const Trapezoid& piece : pieces) {
    const auto line_above = [&](double y) {
      return static_cast<Eigen::Index>(std::ceil(y / domain.size_m.y() * lines - 0.5));
    };
    const Eigen::Index last = std::min(line_above(piece.high), kLines * like.cols());
    for (Eigen::Index line = line_above(piece.low); line < last; ++line) {
      const double y = (static_cast<double>(line) + 0.5) / lines * domain.size_m.y();
      const Trapezoid at = piece.between(y, y);
      for_each_overlap(at.left_low, at.right_low, domain.size_m.x(), like.rows(),
                       [&](Eigen::Index i, double length) {
                         shares(i, line / kLines) += length / (cell_x * kLines);
                       });
    }
  }
  return shares;
}

/// The averages of a one-dimensional Gaussian density over `cells` equal parts of [0, size].
Eigen::VectorXd averages_along(double mean, double deviation, double size, Eigen::Index cells) {
  const double cell = size / static_cast<double>(cells);
  const auto below = [&](Eigen::Index i) {
    return 0.5 * std::erf((static_cast<double>(i) * cell - mean) / (deviation * std::sqrt(2)));
  };
  Eigen::VectorXd averages(cells);
  for (Eigen::Index i = 0; i < cells; ++i) averages[i] = (below(i + 1) - below(i)) / cell;
  return averages;
}

void add_separable(double weight, const PlaneGaussian& gaussian, const Rectangle& domain,
                   DensityGrid& sum) {
  const Eigen::Vector2d mean_m = gaussian.mean_m - domain.origin_m;
  const Eigen::Vector2d deviation_m = gaussian.covariance_m2.diagonal().cwiseSqrt();
  sum += weight * averages_along(mean_m.x(), deviation_m.x(), domain.size_m.x(), sum.rows()) *
         averages_along(mean_m.y(), deviation_m.y(), domain.size_m.y(), sum.cols()).transpose();
}

/// A Gaussian with correlation, averaged over 4 × 4 points of each cell.
void add_correlated(double weight, const PlaneGaussian& gaussian, const Rectangle& domain,
                    DensityGrid& sum) {
  constexpr int kPoints = 4;
  const Eigen::Vector2d step(domain.size_m.x() / static_cast<double>(kPoints * sum.rows()),
                             domain.size_m.y() / static_cast<double>(kPoints * sum.cols()));
  const GaussianDensity density(gaussian);
  const double share = weight / (kPoints * kPoints);
  for (Eigen::Index j = 0; j < kPoints * sum.cols(); ++j) {
    for (Eigen::Index i = 0; i < kPoints * sum.rows(); ++i) {
      const Eigen::Vector2d point(static_cast<double>(i) + 0.5, static_cast<double>(j) + 0.5);
      sum(i / kPoints, j / kPoints) += share * density(domain.origin_m + step.cwiseProduct(point));
    }
  }
}

void add_plane(double weight, const PlaneGaussian& gaussian, const Rectangle& domain,
               DensityGrid& sum) {
  if (gaussian.covariance_m2(0, 1) == 0) {
    add_separable(weight, gaussian, domain, sum);
  } else {
    add_correlated(weight, gaussian, domain, sum);
  }
}

/// What of a Gaussian is between two heights.
void add_gaussian(const Gaussian& gaussian, const Heights& between, const Box& domain,
                  DensityGrid& sum) {
  constexpr int kHeights = 32;
  const GaussianAtHeight g(gaussian);
  const AlongZ along_z(domain, Basis{});
  const bool leans = !domain.planar() && g.leans();
  const int slices = leans ? kHeights : 1;
  const double slice_m = between.length_m() / slices;
  for (int i = 0; i < slices; ++i) {
    const double low_m = between.low_m + i * slice_m;
    const double share =
        along_z.gaussian(g.mean_z_m(), g.deviation_z_m(), {low_m, low_m + slice_m})[0];
    const double seen_at_m = leans ? low_m + 0.5 * slice_m : g.mean_z_m();
    add_plane(gaussian.weight * share, g.at(seen_at_m), base_of(domain), sum);
  }
}

/// All parts between the heights of a storey, added to its maps.
DensityGrid picture_of(const TargetDensity& target, const Storey& storey, DensityGrid sum,
                       const Box& domain) {
  const Rectangle base = base_of(domain);
  const AlongZ along_z(domain, Basis{});
  sum.array() += along_z.uniform(heights_of(domain), storey.heights)[0] * target.uniform_weight /
                 base.size_m.prod();
  for (const Gaussian& gaussian : target.gaussians)
    add_gaussian(gaussian, storey.heights, domain, sum);
  if (!storey.keep_outs.empty())
    sum = sum.cwiseProduct(shares_of(storey.free(base), base, sum)).eval();
  for (const Region& region : target.regions) {
    const double share = along_z.uniform(region.heights, storey.heights)[0];
    sum += share * region.weight / area_m2(region.polygon) *
           shares_of(free_area_within(region.polygon, base, storey.keep_outs), base, sum);
  }
  return sum;
}

}  // namespace

RasterPicture::RasterPicture(const RasterGrid& grid, const Rectangle& domain, int cells_x,
                             int cells_y)
    : grid_(grid), domain_(domain), mass_(DensityGrid::Zero(cells_x, cells_y)) {}

void RasterPicture::add_row(int row, std::span<const double> values) {
  const Eigen::Vector2d cell_m(grid_.extent.size_m.x() / grid_.columns,
                               grid_.extent.size_m.y() / grid_.rows);
  const Eigen::Vector2d low = grid_.extent.origin_m - domain_.origin_m;
  Eigen::VectorXd along = Eigen::VectorXd::Zero(mass_.rows());
  for (int column = 0; column < grid_.columns; ++column) {
    const double value = values[static_cast<std::size_t>(column)];
    if (value == 0) continue;
    whole_ += value * cell_m.x() * cell_m.y();
    for_each_overlap(low.x() + column * cell_m.x(), low.x() + (column + 1) * cell_m.x(),
                     domain_.size_m.x(), mass_.rows(),
                     [&](Eigen::Index i, double length) { along[i] += value * length; });
  }
  for_each_overlap(low.y() + row * cell_m.y(), low.y() + (row + 1) * cell_m.y(), domain_.size_m.y(),
                   mass_.cols(),
                   [&](Eigen::Index j, double length) { mass_.col(j) += length * along; });
}

DensityGrid RasterPicture::density() const {
  const double cells = static_cast<double>(mass_.size());
  return mass_ * (cells / (domain_.size_m.x() * domain_.size_m.y() * whole_));
}

DensityGrid density_picture(const TargetDensity& target, std::span<const DensityGrid> maps,
                            const Box& domain) {
  DensityGrid sum = DensityGrid::Zero(maps[0].rows(), maps[0].cols());
  const std::vector<Storey> storeys = storeys_of(domain, target.keep_outs);
  for (std::size_t i = 0; i < storeys.size(); ++i)
    sum += picture_of(target, storeys[i], maps[i], domain);
  return sum;
}

}  // namespace ergocast
