// SPDX-License-Identifier: BSD-3-Clause
// Adds the integrals of whole cells by columns, and cuts only cells that a slanted side crosses.
#include "target/raster_integral.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/require.h"
#include "target/cosine_integrals.h"

namespace ergocast {
namespace {

constexpr int kModesAtOnce = 16;

/// Corners of a convex polygon, cut from a trapezoid by two verticals: at most six.
struct Corners {
  std::array<Eigen::Vector2d, 8> at;
  std::size_t count = 0;

  void add(const Eigen::Vector2d& corner) { at[count++] = corner; }
  std::span<const Eigen::Vector2d> all() const { return {at.data(), count}; }
};

/// The part of `shape` on one side of x = `limit` (Sutherland and Hodgman's rule).
/// @param side  +1 keeps the part to the right of it, −1 that to the left
Corners cut(const Corners& shape, double limit, double side) {
  Corners kept;
  for (std::size_t i = 0; i < shape.count; ++i) {
    const Eigen::Vector2d &a = shape.at[i], &b = shape.at[(i + 1) % shape.count];
    const double before = side * (a.x() - limit), after = side * (b.x() - limit);
    if (before >= 0) kept.add(a);
    if (before * after < 0) {
      const double share = before / (before - after);
      kept.add({limit, a.y() + share * (b.y() - a.y())});
    }
  }
  return kept;
}

}  // namespace

RasterIntegral::RasterIntegral(const RasterGrid& grid, const Eigen::Vector2d& size_m,
                               const Basis& basis, std::vector<Trapezoid> free)
    : grid_(grid),
      size_m_(size_m),
      cell_m_(grid.extent.size_m.x() / grid.columns, grid.extent.size_m.y() / grid.rows),
      along_x_(Eigen::MatrixXd::Zero(
          (basis.modes_x + kModesAtOnce - 1) / kModesAtOnce * kModesAtOnce, grid.columns)),
      free_(std::move(free)),
      sums_(PlaneCoefficients::Zero(basis.modes_x, basis.modes_y)) {
  ERGOCAST_REQUIRE(grid.columns >= 1 && grid.rows >= 1);
  for (int column = 0; column < grid.columns; ++column) {
    const double low = grid_.extent.origin_m.x() + column * cell_m_.x();
    const double high = grid_.extent.origin_m.x() + (column + 1) * cell_m_.x();
    low_.push_back(std::clamp(low, 0.0, size_m_.x()));
    high_.push_back(std::clamp(high, 0.0, size_m_.x()));
    along_x_.col(column).head(basis.modes_x) =
        cosine_integrals(low_.back(), high_.back(), size_m_.x(), basis.modes_x);
  }
}

void RasterIntegral::add_row(int row, std::span<const double> values) {
  ERGOCAST_REQUIRE(row >= 0 && row < grid_.rows);
  ERGOCAST_REQUIRE(values.size() == static_cast<std::size_t>(grid_.columns));
  double sum = 0;
  for (const double value : values) sum += value;
  if (sum == 0) return;
  whole_ += sum * cell_m_.x() * cell_m_.y();
  const double low = grid_.extent.origin_m.y() + row * cell_m_.y();
  const double high = grid_.extent.origin_m.y() + (row + 1) * cell_m_.y();
  for (const Trapezoid& piece : free_) {
    const double from = std::max(low, piece.low), to = std::min(high, piece.high);
    if (from < to) add_piece(piece.between(from, to), values);
  }
}

/// Columns between the sides are whole and share one integral along y; those that a slanted side
/// crosses are cut.
void RasterIntegral::add_piece(const Trapezoid& piece, std::span<const double> values) {
  const auto [left, inner_left] = std::minmax(piece.left_low, piece.left_high);
  const auto [inner_right, right] = std::minmax(piece.right_low, piece.right_high);
  const auto column_at = [](auto found, const std::vector<double>& all) {
    return static_cast<std::size_t>(found - all.begin());
  };
  // low_ and high_ ascend, so each of these is one place in the row.
  const auto begin = column_at(std::upper_bound(high_.begin(), high_.end(), left), high_);
  const auto end = column_at(std::lower_bound(low_.begin(), low_.end(), right), low_);
  const auto whole_begin = std::clamp(
      column_at(std::lower_bound(low_.begin(), low_.end(), inner_left), low_), begin, end);
  const auto whole_end =
      std::clamp(column_at(std::upper_bound(high_.begin(), high_.end(), inner_right), high_),
                 whole_begin, end);
  for (std::size_t i = begin; i < whole_begin; ++i) add_cut_cell(i, piece, values[i]);
  sums_ += sum_of(values, whole_begin, whole_end) *
           cosine_integrals(piece.low, piece.high, size_m_.y(), static_cast<int>(sums_.cols()))
               .transpose();
  for (std::size_t i = whole_end; i < end; ++i) add_cut_cell(i, piece, values[i]);
}

/// Computes a few modes at a time, so that their sums stay in registers over the whole row.
Eigen::VectorXd RasterIntegral::sum_of(std::span<const double> values, std::size_t begin,
                                       std::size_t end) const {
  Eigen::VectorXd sums(along_x_.rows());
  for (Eigen::Index mode = 0; mode < sums.size(); mode += kModesAtOnce) {
    Eigen::Matrix<double, kModesAtOnce, 1> few = Eigen::Matrix<double, kModesAtOnce, 1>::Zero();
    for (std::size_t i = begin; i < end; ++i) {
      few += values[i] * along_x_.block<kModesAtOnce, 1>(mode, static_cast<Eigen::Index>(i));
    }
    sums.segment<kModesAtOnce>(mode) = few;
  }
  return sums.head(sums_.rows());
}

void RasterIntegral::add_cut_cell(std::size_t column, const Trapezoid& piece, double value) {
  if (value == 0) return;
  Corners shape;
  for (const Eigen::Vector2d& corner : piece.corners()) shape.add(corner);
  const Corners inside = cut(cut(shape, low_[column], 1), high_[column], -1);
  if (inside.count >= 3) rounding_ += add_polygon(inside.all(), value, size_m_, sums_);
}

PlaneIntegrals RasterIntegral::shares() const {
  ERGOCAST_REQUIRE(has_mass());
  // One rounding for each addition of terms of similar size: at most rows + columns of them, and a
  // few.
  const double additions = grid_.columns + grid_.rows + 16;
  const double rounding = 1.2e-16 * additions + rounding_ / whole_;
  return {sums_ / whole_, rounding};
}

}  // namespace ergocast
