// SPDX-License-Identifier: BSD-3-Clause
// Projects both distributions to each direction, into bins of a part of a cell, and compares
// quantiles.
#include "core/measure/transport.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/base/portable_math.h"

namespace ergocast {
namespace {

constexpr int kDirections = 32;
constexpr double kBinsPerCell = 4;

/// Directions that are evenly spread over a half circle, or a half sphere.
std::vector<Eigen::Vector3d> directions(bool planar) {
  std::vector<Eigen::Vector3d> list;
  for (int i = 0; i < kDirections; ++i) {
    if (planar) {
      const double angle = std::numbers::pi * (i + 0.5) / kDirections;
      list.emplace_back(portable::cos(angle), portable::sin(angle), 0);
      continue;
    }
    const double height = (i + 0.5) / kDirections, across = std::sqrt(1 - height * height);
    const double angle = 2 * std::numbers::pi * i / std::numbers::phi;  // Fibonacci's spiral
    list.emplace_back(across * portable::cos(angle), across * portable::sin(angle), height);
  }
  return list;
}

/// Both distributions along a direction, in bins of equal width.
struct Shadow {
  double bin_m;
  std::vector<double> one, other;
};

Shadow shadow_of(const Cells& cells, const Eigen::Vector3d& along, const std::vector<double>& one,
                 const std::vector<double>& other) {
  const auto low_side = [&](int axis) {
    return std::min(0.0, along[axis]) * cells.domain.size_m[axis];
  };
  const double low_m = low_side(0) + low_side(1) + low_side(2);
  const double length_m = along.cwiseAbs().dot(cells.domain.size_m);
  const double cell_m = along.cwiseAbs().dot(cells.size_m);
  const auto bins = static_cast<std::size_t>(std::ceil(length_m / cell_m * kBinsPerCell)) + 1;
  Shadow shadow{length_m / static_cast<double>(bins - 1), std::vector<double>(bins, 0),
                std::vector<double>(bins, 0)};
  const auto middle_m = [&](int axis, int index) {
    return along[axis] * (index + 0.5) * cells.size_m[axis];
  };
  for (int l = 0; l < cells.count.z(); ++l) {
    for (int i = 0; i < cells.count.x(); ++i) {
      const double column_m = middle_m(2, l) + middle_m(0, i) - low_m;
      const std::size_t column = cells.column(i, l);
      for (int j = 0; j < cells.count.y(); ++j) {
        const std::size_t cell = column + static_cast<std::size_t>(j);
        const auto bin =
            static_cast<std::size_t>(std::lround((column_m + middle_m(1, j)) / shadow.bin_m));
        shadow.one[bin] += one[cell];
        shadow.other[bin] += other[cell];
      }
    }
  }
  return shadow;
}

/// ∫ (F⁻¹ − G⁻¹)² in bins², of two distributions with the sums `one_sum` and `other_sum`.
double squared_distance(const Shadow& shadow, double one_sum, double other_sum) {
  double square = 0, done = 0, below_one = 0, below_other = 0;
  std::size_t i = 0, j = 0;
  while (i < shadow.one.size() && j < shadow.other.size()) {
    const double one = below_one + shadow.one[i] / one_sum;
    const double other = below_other + shadow.other[j] / other_sum;
    const double apart = static_cast<double>(i) - static_cast<double>(j);
    const double next = std::min(one, other);
    square += std::max(0.0, next - done) * apart * apart;
    done = std::max(done, next);
    if (one <= other) below_one = one, ++i;
    if (other <= one) below_other = other, ++j;
  }
  return square;
}

}  // namespace

double sliced_wasserstein_m(const Cells& cells, const std::vector<double>& one,
                            const std::vector<double>& other) {
  const double one_sum = std::accumulate(one.begin(), one.end(), 0.0);
  const double other_sum = std::accumulate(other.begin(), other.end(), 0.0);
  if (!(one_sum > 0 && other_sum > 0)) return std::numeric_limits<double>::quiet_NaN();
  double sum_m2 = 0;
  const auto list = directions(cells.domain.planar());
  for (const Eigen::Vector3d& along : list) {
    const Shadow shadow = shadow_of(cells, along, one, other);
    sum_m2 += shadow.bin_m * shadow.bin_m * squared_distance(shadow, one_sum, other_sum);
  }
  return std::sqrt(sum_m2 / static_cast<double>(list.size()));
}

}  // namespace ergocast
