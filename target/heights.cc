// SPDX-License-Identifier: BSD-3-Clause
// Clips a density to the domain's heights, and integrates it there as along any other axis.
#include "target/heights.h"

#include "target/cosine_integrals.h"
#include "target/panels.h"

namespace ergocast {

AlongZ::AlongZ(double height_m, const Basis& basis) : height_m_(height_m), modes_(basis.modes_z) {}

Eigen::VectorXd AlongZ::uniform(const Heights& part, const Heights& within) const {
  if (height_m_ == 0) return Eigen::VectorXd::Ones(1);
  const double low_m = std::max({part.low_m, within.low_m, 0.0});
  const double high_m = std::min({part.high_m, within.high_m, height_m_});
  if (!(low_m < high_m)) return Eigen::VectorXd::Zero(modes_);
  if (low_m == 0 && high_m == height_m_) {  // exactly, as in the plane
    return Eigen::VectorXd::Unit(modes_, 0) * (high_m / part.length_m());
  }
  return cosine_integrals(low_m, high_m, height_m_, modes_) / part.length_m();
}

Eigen::VectorXd AlongZ::gaussian(double mean_m, double deviation_m, const Heights& within) const {
  if (height_m_ == 0) return Eigen::VectorXd::Ones(1);
  const Interval part{std::max(within.low_m, 0.0), std::min(within.high_m, height_m_)};
  if (!(part.low < part.high)) return Eigen::VectorXd::Zero(modes_);
  return integrals_along(mean_m, deviation_m, part, height_m_, modes_);
}

}  // namespace ergocast
