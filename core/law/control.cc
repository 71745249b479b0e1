// SPDX-License-Identifier: BSD-3-Clause
// Weights the residual once for each coverage, then evaluates field, direction, contraction and
// perturbation at the position.
#include "core/law/control.h"

#include <cmath>

#include "core/base/noise.h"
#include "core/base/require.h"
#include "core/base/vectorized.h"
#include "core/law/perturbation.h"
#include "core/mission/kinds.h"

namespace ergocast {

namespace {

/// A box with all sides as long as the longest one. The gradient of a mode is steep across a short
/// side, but means little there. An ε that counted it would keep agents from moving along the other
/// sides.
Box cube_around(const Box& domain) {
  Box cube = domain;
  cube.size_m.head(domain.planar() ? 2 : 3).setConstant(domain.size_m.maxCoeff());
  return cube;
}

}  // namespace

Eigen::Vector3d smooth_input(const Eigen::Vector3d& spectral_gradient, double epsilon,
                             double u_max_mps) {
  // hypot, because B falls below 1e-4: its square would lose the smallest residuals.
  const double b_z = spectral_gradient.z();
  const double length = std::hypot(std::hypot(spectral_gradient.x(), spectral_gradient.y()),
                                   b_z == 0 ? epsilon : std::hypot(b_z, epsilon));
  if (length == 0) return {0, 0, 0};
  // The division comes first: u_max / length overflows where B is close to 0.
  return spectral_gradient / length * -u_max_mps;
}

Controller::Controller(const Mission& mission, int kind)
    : domain_(mission.domain),
      basis_(mission.basis),
      law_(law_of(mission, kind)),
      seed_(mission.seed),
      scale_(law_, mission.timing.dt_s),
      dt_s_(mission.timing.dt_s),
      push_ticks_(push_ticks(law_, mission.timing.dt_s)),
      target_(mission.target_coefficients),
      weights_(steering_weights(mission, kind)),
      energies_(gradient_energies(mission.basis, cube_around(mission.domain))),
      residual_(Coefficients::Zero(mission.basis.mode_count())) {
  ERGOCAST_REQUIRE(target_.size() == mission.basis.mode_count());
  if (!mission.kinds.empty()) metric_weights_ = sobolev_weights(mission.basis, mission.domain);
}

void Controller::set_law(const LawNumbers& numbers) {
  if (numbers == LawNumbers{law_.u_max_mps, law_.noise_intensity, law_.noise_ceiling}) return;
  law_.u_max_mps = numbers.u_max_mps;
  law_.noise_intensity = numbers.noise_intensity;
  law_.noise_ceiling = numbers.noise_ceiling;
  scale_ = PerturbationScale(law_, dt_s_);
  push_ticks_ = push_ticks(law_, dt_s_);
}

void Controller::set_coverage(const Coefficients& coverage) {
  const double residual_gradient = set_residual(coverage);
  epsilon_ = law_.epsilon;
  if (law_.regularization == Regularization::kRelative) epsilon_ *= residual_gradient;
}

ERGOCAST_VECTORIZED
double Controller::set_residual(const Coefficients& coverage) {
  const Eigen::Index count = residual_.size();
  const double* c = coverage.data();
  const double* mu = target_.data();
  const double* weight = weights_.data();
  const double* energy = energies_.data();
  double* __restrict residual = residual_.data();
  // Four partial sums in a fixed order: one chain of additions would cost more than all the rest.
  double partial[4] = {0, 0, 0, 0};
  const auto take = [&](Eigen::Index k, int lane) {
    residual[k] = weight[k] * (c[k] - mu[k]);
    partial[lane] += residual[k] * residual[k] * energy[k];
  };
  Eigen::Index k = 0;
  for (; k + 4 <= count; k += 4) {
    for (int lane = 0; lane < 4; ++lane) take(k + lane, lane);
  }
  for (; k < count; ++k) take(k, 0);
  return std::sqrt((partial[0] + partial[1]) + (partial[2] + partial[3]));
}

Eigen::Vector3d Controller::command(AgentId agent, Tick tick, const Eigen::Vector3d& x_m,
                                    const BasisAt& at) {
  FieldAt field;
  if (law_.perturbation == Perturbation::kAdaptive) {
    field = weighted_field(at, basis_, domain_, residual_.data());
  } else {
    field.gradient = weighted_gradient(at, basis_, residual_.data());
  }
  spectral_gradient_ = field.gradient;
  Eigen::Vector3d velocity = smooth_input(field.gradient, epsilon_, law_.u_max_mps) -
                             law_.contraction_gain_per_s * (x_m - law_.contraction_center_m);
  if (domain_.planar()) velocity.z() = 0;  // instead of −0
  if (law_.max_noise() > 0) {
    const Eigen::Vector3d xi =
        normal_in(domain_, seed_, Purpose::kPerturbation, static_cast<std::uint32_t>(agent),
                  static_cast<std::uint64_t>(tick));
    const Eigen::Vector3d eta = push(agent, tick / push_ticks_);
    velocity += perturbation(scale_, epsilon_, field, xi, eta);
  }
  return velocity;
}

/// η of one stretch of push_ticks_ ticks.
Eigen::Vector3d Controller::push(AgentId agent, Tick stretch) {
  const AgentId drawn = law_.paired_pushes ? agent - agent % 2 : agent;
  Push& last = pushes_[static_cast<std::uint32_t>(drawn) % pushes_.size()];
  if (last.drawn != drawn || last.stretch != stretch) {
    last = {drawn, stretch,
            normal_in(domain_, seed_, Purpose::kPush, static_cast<std::uint32_t>(drawn),
                      static_cast<std::uint64_t>(stretch))};
  }
  return drawn == agent ? last.eta : Eigen::Vector3d(-last.eta);
}

double Controller::metric(const Coefficients& coverage) const {
  return ergodic_metric(coverage, target_, metric_weights_.size() > 0 ? metric_weights_ : weights_);
}

}  // namespace ergocast
