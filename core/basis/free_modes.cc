// SPDX-License-Identifier: BSD-3-Clause
// Reads the table at a place: four cells for the modes, nine for the field of a weighted sum.
#include "core/basis/free_modes.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "core/base/portable_math.h"
#include "core/base/require.h"
#include "core/base/vectorized.h"

namespace ergocast {
namespace {

/// Cells' numbers by their places relative to one of them.
struct Around {
  const std::int32_t* cells;
  int at(int a, int b) const { return cells[(a + 1) * 3 + b + 1]; }
};

Around around(const FreeModes& modes, int cell) {
  return {modes.around.data() + static_cast<std::ptrdiff_t>(cell) * 9};
}

/// The part of the grid in which a coordinate is, `scaled` being 0 … cells.
int part_of(double scaled, int cells) {
  const int part = static_cast<int>(std::floor(scaled * kPartsPerCell));
  return std::clamp(part, 0, cells * kPartsPerCell - 1);
}

/// The middle of a place in the grid, in cells.
Eigen::Vector2d middle_of(int place, int rows) {
  const int column = place / rows, row = place % rows;
  return {column + 0.5, row + 0.5};
}

}  // namespace

Eigen::Vector2d FreeModes::center_m(int cell) const {
  const int at = place[static_cast<std::size_t>(cell)];
  return origin_m + cell_m().cwiseProduct(middle_of(at, rows));
}

FreePlace::FreePlace(const Eigen::Vector2d& x_m, const FreeModes& table) : modes(&table) {
  ERGOCAST_REQUIRE(x_m.allFinite());
  const Eigen::Vector2d cells(table.columns, table.rows);
  const Eigen::Vector2d scaled = (x_m - table.origin_m)
                                     .cwiseQuotient(table.size_m)
                                     .cwiseProduct(cells)
                                     .cwiseMax(0)
                                     .cwiseMin(cells);
  const int part = part_of(scaled.x(), table.columns) * kPartsPerCell * table.rows +
                   part_of(scaled.y(), table.rows);
  cell = table.owner[static_cast<std::size_t>(part)];
  const int at = table.place[static_cast<std::size_t>(cell)];
  offset = (scaled - middle_of(at, table.rows)).cwiseMax(-0.5).cwiseMin(0.5);
  const int a = offset.x() < 0 ? -1 : 1, b = offset.y() < 0 ? -1 : 1;
  const double x = std::abs(offset.x()), y = std::abs(offset.y());
  const Around near = around(table, cell);
  corners = {table.values_of(cell), table.values_of(near.at(a, 0)), table.values_of(near.at(0, b)),
             table.values_of(near.at(a, b))};
  shares = {(1 - x) * (1 - y), x * (1 - y), (1 - x) * y, x * y};
}

namespace {

/// Four doubles, added and multiplied one by one.
using Four [[gnu::vector_size(4 * sizeof(double))]] = double;

/// Σ weights_k e_k of three cells.
ERGOCAST_VECTORIZED_PART void sum_three(const std::array<const float*, 3>& cells,
                                        const double* weights, int count, double* sums) {
  Four partial[3] = {};
  int k = 0;
  for (; k + 4 <= count; k += 4) {
    Four weight;
    std::memcpy(&weight, weights + k, sizeof weight);
    for (int i = 0; i < 3; ++i) {
      const float* const value = cells[i] + k;
      partial[i] += weight * Four{value[0], value[1], value[2], value[3]};
    }
  }
  for (int i = 0; i < 3; ++i) {
    sums[i] = (partial[i][0] + partial[i][1]) + (partial[i][2] + partial[i][3]);
    for (int rest = k; rest < count; ++rest) sums[i] += weights[rest] * cells[i][rest];
  }
}

ERGOCAST_VECTORIZED
void sum_around(const FreePlace& at, const double* weights, double* sums) {
  const FreeModes& modes = *at.modes;
  const std::int32_t* const cells = around(modes, at.cell).cells;
  for (int i = 0; i < 9; i += 3) {
    sum_three(
        {modes.values_of(cells[i]), modes.values_of(cells[i + 1]), modes.values_of(cells[i + 2])},
        weights, modes.mode_count, sums + i);
  }
}

/// The weights of three cells in a row, one cell apart, in the quadratic B-spline at an offset from
/// −½ to ½, and in its derivatives.
struct Spline {
  Eigen::Vector3d value, slope, bend;
  explicit Spline(double t)
      : value(0.5 * (0.5 - t) * (0.5 - t), 0.75 - t * t, 0.5 * (0.5 + t) * (0.5 + t)),
        slope(t - 0.5, -2 * t, t + 0.5),
        bend(1, -2, 1) {}
};

double sum_of(const Eigen::Vector3d& along_x, const double* sums, const Eigen::Vector3d& along_y) {
  double sum = 0;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) sum += along_x[a] * along_y[b] * sums[a * 3 + b];
  }
  return sum;
}

}  // namespace

FreeField free_field(const FreePlace& at, const double* weights) {
  double sums[9];
  sum_around(at, weights, sums);
  const Eigen::Vector2d cell_m = at.modes->cell_m();
  const Spline x(at.offset.x()), y(at.offset.y());
  const double xy = sum_of(x.slope, sums, y.slope) / (cell_m.x() * cell_m.y());
  FreeField field;
  field.gradient << sum_of(x.slope, sums, y.value) / cell_m.x(),
      sum_of(x.value, sums, y.slope) / cell_m.y();
  field.hessian << sum_of(x.bend, sums, y.value) / (cell_m.x() * cell_m.x()), xy, xy,
      sum_of(x.value, sums, y.bend) / (cell_m.y() * cell_m.y());
  return field;
}

Eigen::VectorXd free_weights(const FreeModes& modes, bool squared_norm, double exponent,
                             bool normalized) {
  const double unit_m2 = modes.size_m.prod() / (std::numbers::pi * std::numbers::pi);
  Eigen::VectorXd weights(modes.mode_count);
  for (int k = 0; k < modes.mode_count; ++k) {
    const auto mode = static_cast<std::size_t>(k);
    const double squared = modes.eigenvalues_per_m2[mode] * unit_m2;
    const double base = 1 + (squared_norm ? squared : std::sqrt(squared));
    const double mean_square = k == 0 ? 1 : 0.25;  // of f_k
    const double h_squared = normalized ? modes.free_area_m2() * mean_square : 1;
    weights[k] =
        portable::pow(base, -exponent) * mean_square / modes.mean_squares[mode] / h_squared;
  }
  return weights;
}

Eigen::Matrix2d free_covariance_m2(const FreeModes& modes, const Eigen::VectorXd& target) {
  double mass = 0;
  Eigen::Vector2d mean_m(0, 0);
  Eigen::Matrix2d square_m2 = Eigen::Matrix2d::Zero();
  for (int cell = 0; cell < modes.cell_count; ++cell) {
    double density = 0;  // in multiples of the mean
    for (int k = 0; k < modes.mode_count; ++k) {
      const double share = target[k] / modes.mean_squares[static_cast<std::size_t>(k)];
      density += share * static_cast<double>(modes.values_of(cell)[k]);
    }
    const Eigen::Vector2d x_m = modes.center_m(cell) - modes.origin_m;
    mass += density;
    mean_m += density * x_m;
    square_m2 += density * x_m * x_m.transpose();
  }
  mean_m /= mass;
  Eigen::Matrix2d covariance_m2 = square_m2 / mass - mean_m * mean_m.transpose();
  covariance_m2.diagonal() = covariance_m2.diagonal().cwiseMax(0);
  return covariance_m2;
}

}  // namespace ergocast
