// SPDX-License-Identifier: BSD-3-Clause
// ∫ f_mn of one Gaussian in a plane, over the domain or the free part of it. All lengths are from
// the domain's lower left corner.
#pragma once

#include <span>

#include "target/plane_integrals.h"
#include "target/trapezoids.h"

namespace ergocast {

/// N(mean, covariance) in a plane.
struct PlaneGaussian {
  Eigen::Vector2d mean_m{0, 0};
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Identity();
};

/// N(x) [1/m²].
class GaussianDensity {
 public:
  explicit GaussianDensity(const PlaneGaussian& gaussian);
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
PlaneIntegrals integrals_over_domain(const PlaneGaussian& gaussian, const Eigen::Vector2d& size_m,
                                     const Basis& basis);

/// The same over `pieces` of the domain: panels along y, and at each of their nodes panels along x
/// between the piece's sides, as wide as the Gaussian at that y. They are doubled in the same way.
PlaneIntegrals integrals_over(const PlaneGaussian& gaussian, std::span<const Trapezoid> pieces,
                              const Eigen::Vector2d& size_m, const Basis& basis);

/// The same by panels as wide as the Gaussian, times `width`, and by `refinement` times as many.
PlaneCoefficients integrals_by(const PlaneGaussian& gaussian, std::span<const Trapezoid> pieces,
                               const Eigen::Vector2d& size_m, const Basis& basis, int refinement,
                               double width = 1);

}  // namespace ergocast
