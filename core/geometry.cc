// SPDX-License-Identifier: BSD-3-Clause
// Folds a coordinate back into its side, so that an edge reflects any number of crossings at
// once.
#include "core/geometry.h"

#include <algorithm>
#include <cmath>

#include "core/require.h"

namespace ergocast {
namespace {

double reflect_along(double x, double low, double length) {
  const double high = low + length;
  if (x < low - 2 * length || x > high + 2 * length) {
    x = low + std::remainder(x - low, 2 * length);
  }
  while (x < low || x > high) x = x < low ? 2 * low - x : 2 * high - x;
  return x;
}

}  // namespace

bool Rectangle::contains(const Eigen::Vector2d& x_m) const {
  const Eigen::Vector2d high_m = origin_m + size_m;
  return x_m.x() >= origin_m.x() && x_m.x() <= high_m.x() && x_m.y() >= origin_m.y() &&
         x_m.y() <= high_m.y();
}

double Rectangle::farthest_distance_m(const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d high_m = origin_m + size_m;
  return std::hypot(std::max(std::abs(origin_m.x() - point_m.x()), std::abs(high_m.x() - point_m.x())),
                    std::max(std::abs(origin_m.y() - point_m.y()), std::abs(high_m.y() - point_m.y())));
}

Eigen::Vector2d reflect(const Eigen::Vector2d& x_m, const Rectangle& domain) {
  ERGOCAST_REQUIRE(x_m.allFinite());
  return {reflect_along(x_m.x(), domain.origin_m.x(), domain.size_m.x()),
          reflect_along(x_m.y(), domain.origin_m.y(), domain.size_m.y())};
}

}  // namespace ergocast
