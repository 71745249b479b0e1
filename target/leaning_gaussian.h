// SPDX-License-Identifier: BSD-3-Clause
// A Gaussian in space, seen at one height: a Gaussian in the plane there.
#pragma once

#include "target/gaussian_integrals.h"
#include "target/heights.h"
#include "target/target.h"

namespace ergocast {

/// N(x, y, z) = N(z) · N(x, y | z). The second is the same at every height unless x or y is
/// correlated with z: then its mean moves.
class GaussianAtHeight {
 public:
  explicit GaussianAtHeight(const Gaussian& gaussian);

  bool leans() const { return !slope_.isZero(0); }
  /// The mean and the deviation of z [m].
  double mean_z_m() const { return mean_m_.z(); }
  double deviation_z_m() const { return deviation_z_m_; }

  PlaneGaussian at(double z_m) const;
  double density_z(double z_m) const;  ///< [1/m]

  /// The length along z over which N(x, y | z) moves by its own width [m].
  double scale_z_m() const;

 private:
  Eigen::Vector3d mean_m_;
  double deviation_z_m_;
  Eigen::Vector2d slope_;          // of the mean, by height
  Eigen::Matrix2d covariance_m2_;  // at one height
};

/// sum += weight · ∫ f_lmn N over `pieces` of a domain with a height, between two heights. Panels
/// along z, and at each of their nodes integrals_by(); all are doubled until two successive results
/// agree to 1e-10, or have been doubled twice. Lengths are from the domain's lowest corner.
void add_leaning(const Gaussian& gaussian, std::span<const Trapezoid> pieces,
                 const Heights& between, const Eigen::Vector3d& size_m, const Basis& basis,
                 TargetCoefficients& sum);

}  // namespace ergocast
