// SPDX-License-Identifier: BSD-3-Clause
// Integrates cosines against powers of the place, mode by mode.
#include "lab/shadow/target_covariance.h"

#include <numbers>

#include "core/basis/free_modes.h"

namespace ergocast::lab {
namespace {

/// ∫ (x/L)^power cos(mπx/L) dx / L over [0, L], for the powers 0, 1 and 2.
double moment(int mode, int power) {
  if (mode == 0) return 1.0 / (power + 1);
  const double sign = mode % 2 == 0 ? 1 : -1, k = mode * std::numbers::pi;
  return power == 0 ? 0 : power == 1 ? (sign - 1) / (k * k) : 2 * sign / (k * k);
}

/// The mean of (x_a/L_a) (x_b/L_b) over the density Σ (2 where m > 0) (2 where n > 0) μ_mn cos cos,
/// or of (x_a/L_a)^power for a single axis.
struct Moments {
  const Mission& mission;
  int count(int axis) const {
    const Basis& basis = mission.basis;
    return axis == 0 ? basis.modes_x : axis == 1 ? basis.modes_y : basis.modes_z;
  }
  double mu(const Eigen::Vector3i& mode) const {
    const Basis& basis = mission.basis;
    return mission
        .target_coefficients[(mode.z() * basis.modes_x + mode.x()) * basis.modes_y + mode.y()];
  }
  double of(int axis, int power) const {
    double sum = 0;
    for (int m = 0; m < count(axis); ++m)
      sum += (m > 0 ? 2 : 1) * mu(m * Eigen::Vector3i::Unit(axis)) * moment(m, power);
    return sum;
  }
  double of_both(int a, int b) const {
    double sum = 0;
    for (int m = 0; m < count(a); ++m) {
      for (int n = 0; n < count(b); ++n) {
        const Eigen::Vector3i mode = m * Eigen::Vector3i::Unit(a) + n * Eigen::Vector3i::Unit(b);
        sum += (m > 0 ? 2 : 1) * (n > 0 ? 2 : 1) * mu(mode) * moment(m, 1) * moment(n, 1);
      }
    }
    return sum;
  }
};

/// The covariance of a target in the modes of a free domain: of Σ μ_k e_k / mean e_k² in each cell.
Eigen::Matrix2d free_covariance(const FreeModes& modes, const Coefficients& mu) {
  Eigen::VectorXd shares(modes.cell_count);
  Eigen::Matrix2Xd places_m(2, modes.cell_count);
  for (int cell = 0; cell < modes.cell_count; ++cell) {
    shares[cell] = 0;
    for (int k = 0; k < modes.mode_count; ++k) {
      const double mean_square = modes.mean_squares[static_cast<std::size_t>(k)];
      shares[cell] += mu[k] * static_cast<double>(modes.values_of(cell)[k]) / mean_square;
    }
    places_m.col(cell) = modes.center_m(cell);
  }
  shares /= shares.sum();
  const Eigen::Vector2d mean_m = places_m * shares;
  const Eigen::Matrix2Xd from_mean_m = places_m.colwise() - mean_m;
  return from_mean_m * shares.asDiagonal() * from_mean_m.transpose();
}

}  // namespace

Eigen::Matrix3d target_covariance_m2(const Mission& mission) {
  Eigen::Matrix3d all_m2 = Eigen::Matrix3d::Zero();
  if (mission.basis.free_domain) {
    all_m2.topLeftCorner<2, 2>() =
        free_covariance(*mission.basis.free_modes(), mission.target_coefficients);
    return all_m2;
  }
  const Moments mean{mission};
  const auto& size_m = mission.domain.size_m;
  for (int a = 0; a < (mission.domain.planar() ? 2 : 3); ++a) {
    for (int b = 0; b < (mission.domain.planar() ? 2 : 3); ++b) {
      const double together = a == b ? mean.of(a, 2) : mean.of_both(a, b);
      all_m2(a, b) = (together - mean.of(a, 1) * mean.of(b, 1)) * size_m[a] * size_m[b];
    }
  }
  return all_m2;
}

}  // namespace ergocast::lab
