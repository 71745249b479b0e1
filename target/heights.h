// SPDX-License-Identifier: BSD-3-Clause
// A domain along z, and the integrals of a density along z with each mode.
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "core/base/geometry.h"
#include "core/basis/basis.h"

namespace ergocast {

/// From `low_m` to `high_m` along z [m]; ignored in a plane.
struct Heights {
  double low_m = 0, high_m = 0;

  double length_m() const { return high_m - low_m; }
  bool contain(double z_m) const { return z_m >= low_m && z_m <= high_m; }
};

/// The heights of a domain.
inline Heights heights_of(const Box& domain) {
  return {domain.origin_m.z(), domain.origin_m.z() + domain.size_m.z()};
}

/// The same heights from the domain's floor: its own floor and ceiling become exactly 0 and its
/// height.
inline Heights above_floor(const Heights& heights, const Box& domain) {
  const double ceiling_m = heights_of(domain).high_m;
  const auto above = [&](double z_m) {
    return z_m == ceiling_m ? domain.size_m.z() : z_m - domain.origin_m.z();
  };
  return {above(heights.low_m), above(heights.high_m)};
}

/// Integrals of cos(lπz/H) times a density along z, l = 0 … modes_z − 1, over the part of the
/// domain between two heights, which are from the domain's floor. Entry 0 is the share of the mass
/// that lies there. In a plane each is {1}.
class AlongZ {
 public:
  /// @param height_m  of the domain; 0 is a plane
  AlongZ(double height_m, const Basis& basis);

  /// The integrals of the density that is constant in `part` and has the mass 1.
  Eigen::VectorXd uniform(const Heights& part, const Heights& within) const;
  /// The integrals of N(z; mean, deviation²), exact to rounding.
  Eigen::VectorXd gaussian(double mean_m, double deviation_m, const Heights& within) const;

 private:
  double height_m_;
  int modes_;
};

}  // namespace ergocast
