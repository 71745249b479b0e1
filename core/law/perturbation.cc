// SPDX-License-Identifier: BSD-3-Clause
// Diagonalises the curvature of the field, in a plane in closed form, and scales a push along each
// principal direction.
#include "core/law/perturbation.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/base/portable_math.h"

namespace ergocast {
namespace {

/// √s for the curvature vᵀHv and the part v·B of the field.
double push_gain(double epsilon, double curvature, double part) {
  if (!(curvature < 0)) return 0;
  // hypot and a ratio: ε falls with the residual, and its square would be lost first.
  const double length = portable::hypot(epsilon, part);
  return length == 0 ? 1 : epsilon / length;
}

/// The principal direction in which H bends upwards the most, of length 1.
Eigen::Vector2d principal_direction(const Eigen::Vector2d& difference, double spread) {
  // Its angle is half that of (H_xx − H_yy, 2 H_xy); for a round H any direction is as good.
  const double cos_twice = spread > 0 ? difference.x() / spread : 1;
  return {std::sqrt(std::max(0.0, 0.5 * (1 + cos_twice))),
          std::copysign(std::sqrt(std::max(0.0, 0.5 * (1 - cos_twice))), difference.y())};
}

/// Σ √s (v·η) v over the two principal directions in the plane.
Eigen::Vector2d push_in_plane(double epsilon, const Eigen::Matrix2d& hessian,
                              const Eigen::Vector2d& gradient, const Eigen::Vector2d& eta) {
  // H = mean·1 + spread·(v vᵀ − w wᵀ) with its principal directions v and w, spread ≥ 0.
  const double mean = 0.5 * (hessian(0, 0) + hessian(1, 1));
  const Eigen::Vector2d difference(0.5 * (hessian(0, 0) - hessian(1, 1)), hessian(0, 1));
  const double spread = portable::hypot(difference.x(), difference.y());
  const Eigen::Vector2d v = principal_direction(difference, spread), w(-v.y(), v.x());
  const double along_v = push_gain(epsilon, mean + spread, gradient.dot(v));
  const double along_w = push_gain(epsilon, mean - spread, gradient.dot(w));
  return along_v * eta.dot(v) * v + along_w * eta.dot(w) * w;
}

/// The same over the three principal directions in space.
Eigen::Vector3d push_in_space(double epsilon, const FieldAt& field, const Eigen::Vector3d& eta) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(field.hessian);
  Eigen::Vector3d push(0, 0, 0);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d v = principal.eigenvectors().col(i);
    const double curvature = principal.eigenvalues()[i];
    push += push_gain(epsilon, curvature, field.gradient.dot(v)) * eta.dot(v) * v;
  }
  return push;
}

}  // namespace

Tick push_ticks(const ControlLaw& law, double dt_s) {
  const double held_s = portable::square(law.noise_ceiling / law.u_max_mps);
  // No longer than any mission lasts.
  return static_cast<Tick>(std::clamp(std::ceil(held_s / dt_s - 1e-9), 1.0, 1e9));
}

double greatest_push_mps(const ControlLaw& law, double dt_s) {
  const double floor = law.noise_intensity, ceiling = law.noise_ceiling;
  const double held_s = static_cast<double>(push_ticks(law, dt_s)) * dt_s;
  return std::sqrt((ceiling - floor) * (ceiling + floor) / held_s);
}

double greatest_deviation_mps(const ControlLaw& law, double dt_s) {
  const double noise_mps = law.noise_intensity / std::sqrt(dt_s);
  if (law.perturbation == Perturbation::kConstant) return noise_mps;
  return portable::hypot(noise_mps, greatest_push_mps(law, dt_s));
}

PerturbationScale::PerturbationScale(const ControlLaw& law, double dt_s)
    : is_adaptive(law.perturbation == Perturbation::kAdaptive),
      noise_mps(law.noise_intensity / std::sqrt(dt_s)),
      push_mps(is_adaptive ? greatest_push_mps(law, dt_s) : 0) {}

Eigen::Vector3d perturbation(const PerturbationScale& scale, double epsilon, const FieldAt& field,
                             const Eigen::Vector3d& xi, const Eigen::Vector3d& eta) {
  Eigen::Vector3d velocity_mps = scale.noise_mps * xi;
  if (!scale.is_adaptive) return velocity_mps;
  // Where H has no part along z, the other two principal directions lie in the plane, and nothing
  // is pushed along z.
  if (field.hessian.col(2).isZero(0)) {
    const Eigen::Matrix2d hessian = field.hessian.topLeftCorner<2, 2>();
    velocity_mps.head<2>() +=
        scale.push_mps * push_in_plane(epsilon, hessian, field.gradient.head<2>(), eta.head<2>());
  } else {
    velocity_mps += scale.push_mps * push_in_space(epsilon, field, eta);
  }
  return velocity_mps;
}

}  // namespace ergocast
