// SPDX-License-Identifier: BSD-3-Clause
// The target density ρ and its coefficients μ_k, (3) and (7).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/basis.h"
#include "target/polygon.h"
#include "target/rectangle.h"

namespace ergocast {

/// One Gaussian of the mixture (7).
struct Gaussian {
  double weight = 1;
  Eigen::Vector2d mean_m{0, 0};
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Identity();
};

/// A constant density in a polygon, which may be partly outside the domain.
struct Region {
  double weight = 1;
  Polygon polygon;
};

/// Σ weight·N(mean, covariance) + Σ weight·[x in polygon]/area(polygon) + uniform_weight / area,
/// zero in every keep-out, truncated to the domain and divided by the remaining mass, so that it
/// integrates to 1. A weight is thus the mass of the whole part, before any of it is cut off.
/// Weights need not add up to 1. RasterIntegral adds maps, which are too large to be values.
struct TargetDensity {
  std::vector<Gaussian> gaussians;
  double uniform_weight = 0;
  std::vector<Region> regions{};
  std::vector<Polygon> keep_outs{};  ///< may overlap
};

struct TargetCoefficients {
  PlaneCoefficients values;  ///< μ_mn; values(0,0) = 1
  double error_bound = 0;    ///< how far any entry may be off
};

/// μ_mn = ∫ f_mn ρ over the domain, f not divided by h_k.
///
/// Exact to rounding: the uniform part, regions, and without keep-outs Gaussians with a diagonal
/// covariance. The other Gaussians are integrated by Gauss–Legendre panels, doubled until two
/// successive results agree to 1e-12 or the limit of panels is reached. `error_bound` tells the
/// accuracy reached.
/// @pre weights ≥ 0, covariances positive definite, polygons that do not cross themselves and have
///      an area, some mass inside the domain (mass_inside() > 0).
TargetCoefficients target_coefficients(const TargetDensity& target, const Rectangle& domain,
                                       const Basis& basis);

/// The same before the division: entry (0,0) is mass_inside().
TargetCoefficients target_integrals(const TargetDensity& target, const Rectangle& domain,
                                    const Basis& basis);

/// The integrals of one region, without its weight: entry (0,0) is its free share.
TargetCoefficients region_integrals(const Region& region, const TargetDensity& target,
                                    const Rectangle& domain, const Basis& basis);

/// `integrals` divided by their mass, entry (0,0).
/// @pre it is above 0
TargetCoefficients normalized(TargetCoefficients integrals);

/// Mass of the un-normalised sum that is inside the domain and outside the keep-outs.
double mass_inside(const TargetDensity& target, const Rectangle& domain);

/// ρ(x) inside the domain [1/m²], before the division by mass_inside().
double density_unscaled(const TargetDensity& target, const Rectangle& domain,
                        const Eigen::Vector2d& x_m);

}  // namespace ergocast
