#include "core/raster_integral.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/cosine_integrals.h"
#include "core/require.h"

namespace ergocast {
namespace {

/// Corners of a convex polygon that is cut out of a trapezoid by two verticals: at most six.
struct Corners {
  std::array<Eigen::Vector2d, 8> at;
  std::size_t count = 0;

  void add(const Eigen::Vector2d& corner) { at[count++] = corner; }
  std::span<const Eigen::Vector2d> all() const { return {at.data(), count}; }
};

/// The part of `shape` on one side of x = `limit` (Sutherland and Hodgman's rule).
/// @param side  +1 keeps what is right of it, −1 what is left
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

RasterIntegral::RasterIntegral(const RasterGrid& grid, const Rectangle& domain, const Basis& basis,
                               std::vector<Trapezoid> free)
    : grid_(grid),
      size_m_(domain.size_m),
      cell_m_(grid.extent.size_m.x() / grid.columns, grid.extent.size_m.y() / grid.rows),
      origin_m_(grid.extent.origin_m - domain.origin_m),
      along_x_(basis.modes_x, grid.columns),
      free_(std::move(free)),
      row_sum_(basis.modes_x),
      sums_(Coefficients::Zero(basis.modes_x, basis.modes_y)) {
  ERGOCAST_REQUIRE(grid.columns >= 1 && grid.rows >= 1);
  for (int column = 0; column < grid.columns; ++column) {
    const double low = origin_m_.x() + column * cell_m_.x();
    const double high = origin_m_.x() + (column + 1) * cell_m_.x();
    low_.push_back(std::clamp(low, 0.0, size_m_.x()));
    high_.push_back(std::clamp(high, 0.0, size_m_.x()));
    along_x_.col(column) =
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
  const double low = origin_m_.y() + row * cell_m_.y();
  const double high = origin_m_.y() + (row + 1) * cell_m_.y();
  for (const Trapezoid& piece : free_) {
    const double from = std::max(low, piece.low), to = std::min(high, piece.high);
    if (from < to) add_piece(piece.between(from, to), values);
  }
}

/// Columns between the sides are whole and share one integral along y; those that a slanted side
/// passes through are cut.
void RasterIntegral::add_piece(const Trapezoid& piece, std::span<const double> values) {
  const auto [left, inner_left] = std::minmax(piece.left_low, piece.left_high);
  const auto [inner_right, right] = std::minmax(piece.right_low, piece.right_high);
  const auto first = std::upper_bound(high_.begin(), high_.end(), left) - high_.begin();
  row_sum_.setZero();
  for (auto i = static_cast<std::size_t>(first); i < low_.size() && low_[i] < right; ++i) {
    if (values[i] == 0 || low_[i] == high_[i]) continue;
    if (low_[i] >= inner_left && high_[i] <= inner_right) {
      row_sum_ += values[i] * along_x_.col(static_cast<Eigen::Index>(i));
    } else {
      add_cut_cell(static_cast<int>(i), piece, values[i]);
    }
  }
  sums_ += row_sum_ * cosine_integrals(piece.low, piece.high, size_m_.y(),
                                       static_cast<int>(sums_.cols())).transpose();
}

void RasterIntegral::add_cut_cell(int column, const Trapezoid& piece, double value) {
  const auto i = static_cast<std::size_t>(column);
  Corners shape;
  for (const Eigen::Vector2d& corner : piece.corners()) shape.add(corner);
  const Corners inside = cut(cut(shape, low_[i], 1), high_[i], -1);
  if (inside.count >= 3) rounding_ += add_polygon(inside.all(), value, size_m_, sums_);
}

TargetCoefficients RasterIntegral::shares() const {
  ERGOCAST_REQUIRE(has_mass());
  // One rounding an addition, all of terms of one size: at most rows + columns of them, and a few.
  const double additions = grid_.columns + grid_.rows + 16;
  const double rounding = 1.2e-16 * additions + rounding_ / whole_;
  return {sums_ / whole_, rounding};
}

}  // namespace ergocast
