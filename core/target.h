// The target density ρ and its coefficients μ_k, (3) and (7).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/basis.h"
#include "core/geometry.h"

namespace ergocast {

/// One bell of the mixture (7).
struct Gaussian {
  double weight = 1;
  Eigen::Vector2d mean_m{0, 0};
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Identity();
};

/// Σ weight·N(mean, covariance) + uniform_weight / area, truncated to the domain and divided by
/// what is left inside, so that it integrates to 1. Weights need not add up to 1.
struct TargetDensity {
  std::vector<Gaussian> gaussians;
  double uniform_weight = 0;
};

struct TargetCoefficients {
  Coefficients values;     ///< μ_mn; values(0,0) = 1
  double error_bound = 0;  ///< how far any entry may be off
};

/// μ_mn = ∫ f_mn ρ over the domain, f not divided by h_k.
///
/// A Gaussian with a diagonal covariance is a product of two one-dimensional integrals, exact to
/// rounding (about 1e-14); one with correlation is integrated by Gauss–Legendre panels over the
/// domain, doubled until two successive results agree to 1e-12 or the limit of panels is reached;
/// `error_bound` says what was reached.
/// @pre weights ≥ 0, covariances positive definite, some mass inside the domain
///      (mass_inside() > 0).
TargetCoefficients target_coefficients(const TargetDensity& target, const Rectangle& domain,
                                       const Basis& basis);

/// Share of the un-normalised mixture that lies in the domain, by weight.
double mass_inside(const TargetDensity& target, const Rectangle& domain);

/// ρ(x) inside the domain [1/m²], before the division by mass_inside().
double density_unscaled(const TargetDensity& target, const Rectangle& domain,
                        const Eigen::Vector2d& x_m);

}  // namespace ergocast
