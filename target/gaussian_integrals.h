// SPDX-License-Identifier: BSD-3-Clause
// ∫ f_mn of one Gaussian, over the domain or the free part of it.
#pragma once

#include <span>

#include "target/target.h"
#include "target/trapezoids.h"

namespace ergocast {

/// N(x) of one Gaussian, without its weight [1/m²].
class GaussianDensity {
 public:
  explicit GaussianDensity(const Gaussian& gaussian);
  double operator()(const Eigen::Vector2d& x_m) const;

 private:
  Eigen::Vector2d mean_m_;
  Eigen::Matrix2d precision_;
  double scale_;
};

/// ∫ f_mn N over the whole domain. With a diagonal covariance it is a product of two
/// one-dimensional integrals, exact to rounding (about 1e-14). With correlation, Gauss–Legendre
/// panels are doubled until two successive results agree to 1e-12 or the limit of panels is
/// reached.
TargetCoefficients integrals_over_domain(const Gaussian& gaussian, const Rectangle& domain,
                                         const Basis& basis);

/// The same over `pieces` of the domain: panels along y, and at each of their nodes panels along x
/// between the piece's sides, as wide as the Gaussian at that y. They are doubled in the same way.
TargetCoefficients integrals_over(const Gaussian& gaussian, std::span<const Trapezoid> pieces,
                                  const Rectangle& domain, const Basis& basis);

}  // namespace ergocast
