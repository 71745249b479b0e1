// SPDX-License-Identifier: BSD-3-Clause
// The target density ρ and its coefficients μ_k, (3) and (7).
//
// A part of a target is seen from above: a density in the plane, times one along z. So its
// coefficients are products, and a plane is the case of the factor 1. Keep-outs divide the height
// into storeys (target/storeys.h), in each of which this holds.
//
// The functions here take any coordinates. The functions that they call use only lengths from the
// domain's lowest corner. There the domain is exactly [0, size], while origin + size − origin may
// differ from size.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "core/basis/basis.h"
#include "target/heights.h"
#include "target/plane_integrals.h"
#include "target/polygon.h"
#include "target/storeys.h"

namespace ergocast {

/// One Gaussian of the mixture (7); in a plane its part along z does not count.
struct Gaussian {
  double weight = 1;
  Eigen::Vector3d mean_m{0, 0, 0};
  Eigen::Matrix3d covariance_m2 = Eigen::Matrix3d::Identity();
};

/// A Gaussian of a plane.
Gaussian plane_gaussian(double weight, const Eigen::Vector2d& mean_m,
                        const Eigen::Matrix2d& covariance_m2);

/// A constant density in a prism, which may be partly outside the domain.
struct Region {
  double weight = 1;
  Polygon polygon;
  Heights heights{};
};

/// Σ weight·N(mean, covariance) + Σ weight·[x in region]/content(region) + uniform_weight /
/// content, zero in every keep-out and truncated to the domain. It is divided by the remaining
/// mass, so that it integrates to 1. A weight is thus the mass of the whole part, before any of it
/// is cut off. Weights need not add up to 1. RasterIntegral adds maps, which are too large to be
/// values.
struct TargetDensity {
  std::vector<Gaussian> gaussians;
  double uniform_weight = 0;
  std::vector<Region> regions{};
  std::vector<KeepOut> keep_outs{};  ///< may overlap
};

/// The same target from the corner `domain.origin_m`.
TargetDensity from_corner(const TargetDensity& target, const Box& domain);

struct TargetCoefficients {
  Coefficients values;     ///< μ_k; values[0] = 1
  double error_bound = 0;  ///< how far any entry may be off
};

/// μ_k = ∫ f_k ρ over the domain, f not divided by h_k.
///
/// Exact to rounding: the uniform part, regions, and without keep-outs Gaussians with a diagonal
/// covariance. The other Gaussians are integrated by Gauss–Legendre panels, doubled until two
/// successive results agree to 1e-12 (1e-10 where x or y is correlated with z) or the limit of
/// panels is reached. `error_bound` is the accuracy reached.
/// @pre weights ≥ 0, covariances positive definite, polygons that do not cross themselves and have
///      an area, heights of a box in order, some mass inside the domain (mass_inside() > 0).
TargetCoefficients target_coefficients(const TargetDensity& target, const Box& domain,
                                       const Basis& basis);

/// The same before the division: entry 0 is mass_inside().
TargetCoefficients target_integrals(const TargetDensity& target, const Box& domain,
                                    const Basis& basis);

/// sum += weight · plane(m,n) · along_z(l).
void add_product(double weight, const PlaneIntegrals& plane, const Eigen::VectorXd& along_z,
                 TargetCoefficients& sum);

/// The share of one region, by its mass, that is inside the domain and outside the keep-outs.
double free_share(const Region& region, const TargetDensity& target, const Box& domain);

/// `integrals` divided by their mass, entry 0.
/// @pre it is above 0
TargetCoefficients normalized(TargetCoefficients integrals);

/// Mass of the un-normalised sum that is inside the domain and outside the keep-outs.
double mass_inside(const TargetDensity& target, const Box& domain);

/// ρ(x) inside the domain [1/m², in a box 1/m³], before the division by mass_inside().
double density_unscaled(const TargetDensity& target, const Box& domain, const Eigen::Vector3d& x_m);

}  // namespace ergocast
