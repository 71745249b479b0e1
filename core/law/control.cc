// SPDX-License-Identifier: BSD-3-Clause
// Weights the residual once for each coverage, then evaluates the field at the position.
#include "core/law/control.h"

#include <cmath>

#include "core/base/require.h"
#include "core/base/vectorized.h"
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

Controller::Controller(const Mission& mission, int kind)
    : domain_(mission.domain),
      basis_(mission.basis),
      steering_(mission, kind),
      target_(mission.target_coefficients),
      weights_(steering_weights(mission, kind)),
      energies_(gradient_energies(mission.basis, cube_around(mission.domain))),
      residual_(Coefficients::Zero(mission.basis.mode_count())) {
  ERGOCAST_REQUIRE(target_.size() == mission.basis.mode_count());
  if (!mission.kinds.empty()) metric_weights_ = sobolev_weights(mission.basis, mission.domain);
}

void Controller::set_coverage(const Coefficients& coverage) {
  epsilon_ = steering_.epsilon(set_residual(coverage));
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
  if (steering_.needs_curvature()) {
    field = weighted_field(at, basis_, domain_, residual_.data());
  } else {
    field.gradient = weighted_gradient(at, basis_, residual_.data());
  }
  spectral_gradient_ = field.gradient;
  return steering_.velocity_mps(agent, tick, x_m, field, epsilon_);
}

double Controller::metric(const Coefficients& coverage) const {
  return ergodic_metric(coverage, target_, metric_weights_.size() > 0 ? metric_weights_ : weights_);
}

}  // namespace ergocast
