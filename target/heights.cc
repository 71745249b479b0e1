// SPDX-License-Identifier: BSD-3-Clause
// Clips a density to the domain's heights, and integrates it there as along any other axis.
#include "target/heights.h"

#include "target/cosine_integrals.h"
#include "target/panels.h"

namespace ergocast {

AlongZ::AlongZ(const Box& domain, const Basis& basis)
    : planar_(domain.planar()), domain_(heights_of(domain)), modes_(basis.modes_z) {}

Eigen::VectorXd AlongZ::uniform(const Heights& part, const Heights& within) const {
  if (planar_) return Eigen::VectorXd::Ones(1);
  const double low_m = std::max({part.low_m, within.low_m, domain_.low_m}) - domain_.low_m;
  const double high_m = std::min({part.high_m, within.high_m, domain_.high_m}) - domain_.low_m;
  if (!(low_m < high_m)) return Eigen::VectorXd::Zero(modes_);
  if (low_m == 0 && high_m == domain_.length_m()) {  // exactly, as in the plane
    return Eigen::VectorXd::Unit(modes_, 0) * (high_m / part.length_m());
  }
  return cosine_integrals(low_m, high_m, domain_.length_m(), modes_) / part.length_m();
}

Eigen::VectorXd AlongZ::gaussian(double mean_m, double deviation_m, const Heights& within) const {
  if (planar_) return Eigen::VectorXd::Ones(1);
  const Interval part{std::max(within.low_m, domain_.low_m),
                      std::min(within.high_m, domain_.high_m)};
  if (!(part.low < part.high)) return Eigen::VectorXd::Zero(modes_);
  return integrals_along(mean_m, deviation_m, part, domain_.low_m, domain_.length_m(), modes_);
}

}  // namespace ergocast
