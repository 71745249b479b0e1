// SPDX-License-Identifier: BSD-3-Clause
// Integrates over the plane at each node along z.
#include "target/leaning_gaussian.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/portable_math.h"
#include "target/panels.h"

namespace ergocast {
namespace {

/// The width of a panel in widths of the Gaussian: its eight nodes are then accurate to 1e-11.
constexpr double kWidth = 2;

TargetCoefficients integrals_by(const Gaussian& gaussian, std::span<const Trapezoid> pieces,
                                const Interval& part, const Eigen::Vector3d& size_m,
                                const Basis& basis, int refinement) {
  const GaussianAtHeight g(gaussian);
  TargetCoefficients sum{Coefficients::Zero(basis.mode_count()), 0};
  const Interval over = reached(g.mean_z_m(), g.deviation_z_m(), part);
  if (!(over.length() > 0)) return sum;
  const double wave = std::numbers::pi / size_m.z();
  const Rule z =
      panels_on(over, panel_scale(kWidth * g.scale_z_m(), wave, basis.modes_z), refinement);
  Eigen::VectorXd along_z(basis.modes_z);
  for (Eigen::Index i = 0; i < z.x.size(); ++i) {
    along_z.setZero();
    add_cosines(z.weight[i] * g.density_z(z.x[i]), wave * z.x[i], along_z);
    const PlaneIntegrals plane{
        ergocast::integrals_by(g.at(z.x[i]), pieces, size_m.head<2>(), basis, refinement, kWidth),
        0};
    add_product(gaussian.weight, plane, along_z, sum);
  }
  return sum;
}

}  // namespace

GaussianAtHeight::GaussianAtHeight(const Gaussian& g)
    : mean_m_(g.mean_m),
      deviation_z_m_(std::sqrt(g.covariance_m2(2, 2))),
      slope_(g.covariance_m2.topRightCorner<2, 1>() / g.covariance_m2(2, 2)),
      covariance_m2_(g.covariance_m2.topLeftCorner<2, 2>() -
                     g.covariance_m2(2, 2) * slope_ * slope_.transpose()) {}

PlaneGaussian GaussianAtHeight::at(double z_m) const {
  return {mean_m_.head<2>() + slope_ * (z_m - mean_m_.z()), covariance_m2_};
}

double GaussianAtHeight::density_z(double z_m) const {
  const double z = (z_m - mean_m_.z()) / deviation_z_m_;
  return portable::exp(-0.5 * z * z) / (deviation_z_m_ * std::sqrt(2 * std::numbers::pi));
}

double GaussianAtHeight::scale_z_m() const {
  const double moved = std::sqrt(slope_.dot(covariance_m2_.inverse() * slope_));  // widths a metre
  return std::min(deviation_z_m_, 1 / moved);
}

void add_leaning(const Gaussian& gaussian, std::span<const Trapezoid> pieces,
                 const Heights& between, const Eigen::Vector3d& size_m, const Basis& basis,
                 TargetCoefficients& sum) {
  constexpr int kMostRefined = 4;
  constexpr double kTolerance = 1e-10;
  const Interval part{std::max(between.low_m, 0.0), std::min(between.high_m, size_m.z())};
  int refinement = 1;
  TargetCoefficients result = integrals_by(gaussian, pieces, part, size_m, basis, refinement);
  do {
    refinement *= 2;
    TargetCoefficients finer = integrals_by(gaussian, pieces, part, size_m, basis, refinement);
    // The agreement of the rules does not show the rounding that they share.
    finer.error_bound =
        (finer.values - result.values).cwiseAbs().maxCoeff() + 1e-14 * gaussian.weight;
    result = std::move(finer);
  } while (result.error_bound > kTolerance * gaussian.weight && refinement < kMostRefined);
  sum.values += result.values;
  sum.error_bound += result.error_bound;
}

}  // namespace ergocast
