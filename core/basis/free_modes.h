// SPDX-License-Identifier: BSD-3-Clause
// Modes of a domain with walls: eigenfunctions of its Laplacian, as a table over a grid.
//
//   −∇²f_k = ν_k f_k in the free domain,   n · ∇f_k = 0 at its walls and sides,   f_0 = 1
//   mean over the free domain of f_k² = ¼ for k > 0,   λ_k = (1 + ν_k L²/π²)^−s,   L² = Lx Ly
//
// In a domain without walls they are cosines. A wall has no value: each cell reads its neighbours
// as they are seen from this cell, so the two sides of a wall are independent.
//
// The table holds e_k = f_k / max |f_k|, so |e_k| ≤ 1 as for cosines, and sums, averages and limits
// on the wire stay what they are. The weights of e_k have the factor max² |f_k|, so φ² and (6) are
// those of f_k. modes/ computes such a table.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace ergocast {

/// The number of parts of a cell along an axis. Each part belongs to one free cell.
inline constexpr int kPartsPerCell = 4;

/// The content of a table. Cell numbers are those of the free cells, 0 … cell_count − 1.
struct FreeModes {
  Eigen::Vector2d origin_m{0, 0}, size_m{1, 1};  ///< of the domain
  int columns = 1, rows = 1;                     ///< cells along x and y
  int mode_count = 0, cell_count = 0;
  std::uint64_t hash = 0;  ///< of the table's file
  std::uint64_t key = 0;   ///< of what it was computed from

  /// The free cell that a part of the grid belongs to; part (i, j) at i · kPartsPerCell · rows + j.
  std::span<const std::int32_t> owner;
  /// Where a free cell is in the grid: column · rows + row.
  std::span<const std::int32_t> place;
  /// What each free cell sees at (column + a, row + b), with a and b from −1 to 1: nine cells, at
  /// (a + 1) · 3 + b + 1. It sees itself in place of a wall.
  std::span<const std::int32_t> around;
  std::span<const double> eigenvalues_per_m2;  ///< ν_k, ascending
  std::span<const double> mean_squares;        ///< of e_k
  std::span<const float> values;               ///< e_k of a cell at cell · mode_count + k

  std::span<const std::byte> file;      ///< all of it, as the table's file has it
  std::shared_ptr<const void> storage;  ///< what the spans point into

  Eigen::Vector2d cell_m() const { return {size_m.x() / columns, size_m.y() / rows}; }
  double free_area_m2() const { return cell_m().prod() * cell_count; }
  const float* values_of(int cell) const {
    return values.data() + static_cast<std::ptrdiff_t>(cell) * mode_count;
  }
  /// The middle of a free cell.
  Eigen::Vector2d center_m(int cell) const;
};

/// A place in the table: e_k there is the bilinear interpolation of four cells.
struct FreePlace {
  const FreeModes* modes = nullptr;  ///< null: none
  int cell = 0;                      ///< to which the place belongs
  Eigen::Vector2d offset{0, 0};      ///< from its middle, in cells, from −½ to ½
  std::array<const float*, 4> corners{};
  std::array<double, 4> shares{};  ///< of each corner; their sum is 1

  FreePlace() = default;
  /// A place outside the domain becomes the nearest place inside.
  /// @pre x_m is finite
  FreePlace(const Eigen::Vector2d& x_m, const FreeModes& modes);
};

/// Σ weights_k e_k as a field around a place: its slope and its bend.
struct FreeField {
  Eigen::Vector2d gradient{0, 0};
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
};

/// The field of the quadratic spline through the nine cells around, which has no slope across a
/// wall. The order of the sums is the same on every processor. Does not allocate.
FreeField free_field(const FreePlace& at, const double* weights);

/// λ_k max² |f_k| of each mode: the weights of e_k.
/// @param squared_norm  λ = (1 + ν L²/π²)^−s, else (1 + √ν L/π)^−s
/// @param normalized  divided by ∫ f_k² over the free domain
Eigen::VectorXd free_weights(const FreeModes& modes, bool squared_norm, double exponent,
                             bool normalized);

/// The covariance [m²] of a mass whose coefficients are `target`, over the free cells.
Eigen::Matrix2d free_covariance_m2(const FreeModes& modes, const Eigen::VectorXd& target);

}  // namespace ergocast
