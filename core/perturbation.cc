#include "core/perturbation.h"

#include <algorithm>
#include <cmath>

namespace ergocast {
namespace {

/// σ_v for the curvature vᵀHv and the part v·B of the field.
double intensity_along(const ControlLaw& law, double epsilon, double curvature, double part) {
  if (!(curvature < 0)) return law.noise_intensity;
  // hypot and a ratio: ε falls with the residual, and its square would be lost first.
  const double length = std::hypot(epsilon, part);
  const double share = length == 0 ? 1 : epsilon / length;
  const double floor = law.noise_intensity, ceiling = law.noise_ceiling;
  return std::sqrt(floor * floor + (ceiling * ceiling - floor * floor) * (share * share));
}

/// The principal direction in which H bends upwards the most, of length 1.
Eigen::Vector2d steepest_bend(const Eigen::Vector2d& difference, double spread) {
  // Its angle is half that of (H_xx − H_yy, 2 H_xy); for a round H any direction is as good.
  const double cos_twice = spread > 0 ? difference.x() / spread : 1;
  return {std::sqrt(std::max(0.0, 0.5 * (1 + cos_twice))),
          std::copysign(std::sqrt(std::max(0.0, 0.5 * (1 - cos_twice))), difference.y())};
}

}  // namespace

Eigen::Vector2d perturbation(const ControlLaw& law, double dt_s, double epsilon,
                             const FieldAt& field, const Eigen::Vector2d& xi) {
  const double root_dt = std::sqrt(dt_s);
  if (law.perturbation == Perturbation::kConstant) return law.noise_intensity / root_dt * xi;
  // H = mean·1 + spread·(v vᵀ − w wᵀ) with its principal directions v and w, spread ≥ 0.
  const Eigen::Matrix2d& hessian = field.hessian;
  const double mean = 0.5 * (hessian(0, 0) + hessian(1, 1));
  const Eigen::Vector2d difference(0.5 * (hessian(0, 0) - hessian(1, 1)), hessian(0, 1));
  const double spread = std::hypot(difference.x(), difference.y());
  const Eigen::Vector2d v = steepest_bend(difference, spread), w(-v.y(), v.x());
  const double along_v = intensity_along(law, epsilon, mean + spread, field.gradient.dot(v));
  const double along_w = intensity_along(law, epsilon, mean - spread, field.gradient.dot(w));
  return along_v / root_dt * xi.dot(v) * v + along_w / root_dt * xi.dot(w) * w;
}

}  // namespace ergocast
