// SPDX-License-Identifier: BSD-3-Clause
// Folds each coordinate back into its interval, so that a side reflects any number of crossings at
// once.
#include "core/base/geometry.h"

#include <algorithm>
#include <cmath>

#include "core/base/portable_math.h"
#include "core/base/require.h"

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

bool Box::contains(const Eigen::Vector3d& x_m) const {
  const Eigen::Vector3d high_m = origin_m + size_m;
  const auto within = [&](int axis) {
    return x_m[axis] >= origin_m[axis] && x_m[axis] <= high_m[axis];
  };
  return within(0) && within(1) && (planar() || within(2));
}

Eigen::Vector3d Box::nearest(const Eigen::Vector3d& x_m) const {
  if (contains(x_m)) return x_m;
  return x_m.cwiseMax(origin_m).cwiseMin(origin_m + size_m);
}

double Box::shortest_side_m() const {
  const double in_plane_m = std::min(size_m.x(), size_m.y());
  return planar() ? in_plane_m : std::min(in_plane_m, size_m.z());
}

double Box::content() const {
  const double area_m2 = size_m.x() * size_m.y();
  return planar() ? area_m2 : area_m2 * size_m.z();
}

double Box::farthest_distance_m(const Eigen::Vector3d& point_m) const {
  const Eigen::Vector3d high_m = origin_m + size_m;
  const Eigen::Vector3d away_m =
      (origin_m - point_m).cwiseAbs().cwiseMax((high_m - point_m).cwiseAbs());
  const double in_plane_m = portable::hypot(away_m.x(), away_m.y());
  return planar() ? in_plane_m : portable::hypot(in_plane_m, away_m.z());
}

Eigen::Vector3d reflect(const Eigen::Vector3d& x_m, const Box& domain) {
  ERGOCAST_REQUIRE(x_m.allFinite());
  const auto along = [&](int axis) {
    return reflect_along(x_m[axis], domain.origin_m[axis], domain.size_m[axis]);
  };
  return {along(0), along(1), domain.planar() ? domain.origin_m.z() : along(2)};
}

Eigen::Vector3d within_speed(const Eigen::Vector3d& v_mps, double limit_mps) {
  // The division comes first, so that no length overflows.
  const double greatest_mps = v_mps.cwiseAbs().maxCoeff();
  if (greatest_mps == 0) return v_mps;
  const Eigen::Vector3d share = v_mps / greatest_mps;
  const double length = portable::hypot(portable::hypot(share.x(), share.y()), share.z());
  if (length * greatest_mps <= limit_mps) return v_mps;
  return share / length * limit_mps;
}

}  // namespace ergocast
