// SPDX-License-Identifier: BSD-3-Clause
// A domain along z: what a density along z makes of each mode.
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "core/basis.h"
#include "core/geometry.h"

namespace ergocast {

/// From `low_m` to `high_m` along z [m]; in a plane they do not count.
struct Heights {
  double low_m = 0, high_m = 0;

  double length_m() const { return high_m - low_m; }
  bool contain(double z_m) const { return z_m >= low_m && z_m <= high_m; }
};

/// Those of a domain.
inline Heights heights_of(const Box& domain) {
  return {domain.origin_m.z(), domain.origin_m.z() + domain.size_m.z()};
}

/// Integrals of cos(lπz/H) times a density along z, l = 0 … modes_z − 1, over the part of the
/// domain between two heights. Entry 0 is the share of the mass that lies there. In a plane each is
/// {1}.
class AlongZ {
 public:
  AlongZ(const Box& domain, const Basis& basis);

  /// Of the density that is constant in `part` and has the mass 1.
  Eigen::VectorXd uniform(const Heights& part, const Heights& within) const;
  /// Of N(z; mean, deviation²), exact to rounding.
  Eigen::VectorXd gaussian(double mean_m, double deviation_m, const Heights& within) const;

 private:
  bool planar_;
  Heights domain_;
  int modes_;
};

}  // namespace ergocast
