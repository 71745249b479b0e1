// SPDX-License-Identifier: BSD-3-Clause
// Carries the covariances of the deviation and of its past along the path without noise.
#include "studies/theorems/linearised.h"

#include <cmath>

#include "core/base/noise.h"
#include "core/base/require.h"
#include "core/basis/basis.h"
#include "core/law/control.h"
#include "lab/manifolds.h"

namespace ergocast::studies {
namespace {

/// n·∇f_k(x) of every mode.
Eigen::VectorXd slopes_along(const Eigen::Vector2d& normal, const BasisAt& at, const Basis& basis) {
  Eigen::VectorXd slopes(basis.mode_count());
  for (int m = 0; m < basis.modes_x; ++m) {
    for (int n = 0; n < basis.modes_y; ++n) {
      slopes[m * basis.modes_y + n] =
          normal.x() * at.slope_x[m] * at.cos_y[n] + normal.y() * at.cos_x[m] * at.slope_y[n];
    }
  }
  return slopes;
}

}  // namespace

Normal normal_of(const Mission& mission) {
  ERGOCAST_REQUIRE(mission.starts_m.size() == 1);
  const auto set = lab::manifold_at(mission.starts_m.front(), mission.domain);
  ERGOCAST_REQUIRE(set.has_value());
  if (set->kind == lab::ManifoldKind::kCorner) return {{1, 0}, 2};
  ERGOCAST_REQUIRE(!set->normal.isZero());
  return {set->normal, 1};
}

std::vector<LinearStep> linearised(const Mission& mission, Tick steps) {
  const Eigen::Vector2d normal = normal_of(mission).direction;
  const Eigen::Vector3d start_m = mission.starts_m.front();
  Mission noise_free = mission;
  noise_free.law.noise_intensity = 0;
  const double dt_s = mission.timing.dt_s;
  const Coefficients weights = sobolev_weights(mission.basis, mission.domain);
  Coefficients sums = Coefficients::Zero(mission.basis.mode_count());
  Controller controller(noise_free);
  Eigen::Vector3d x_m = start_m;
  std::vector<LinearStep> result;
  for (Tick tick = 0; tick < steps; ++tick) {
    const BasisAt at(x_m, mission.domain, mission.basis);
    accumulate_basis(at, mission.basis, 1, sums.data());
    const Coefficients coverage = sums / static_cast<double>(tick + 1);
    controller.set_coverage(coverage);
    const Eigen::Vector3d v_mps = controller.command(0, tick, x_m, at);
    const double length = std::hypot(controller.spectral_gradient().norm(), controller.epsilon());
    const Coefficients residual = weights.cwiseProduct(coverage - mission.target_coefficients);
    const Eigen::Matrix2d hessian =
        weighted_field(at, mission.basis, mission.domain, residual.data())
            .hessian.topLeftCorner<2, 2>();
    const double gain = mission.law.u_max_mps / length;
    result.push_back({-gain * normal.dot(hessian * normal) - mission.law.contraction_gain_per_s,
                      gain * dt_s / static_cast<double>(tick + 1),
                      slopes_along(normal, at, mission.basis)});
    x_m = reflect(x_m + v_mps * dt_s, mission.domain);
    x_m.head<2>() -= normal * normal.dot((x_m - start_m).head<2>());
  }
  return result;
}

std::vector<double> spread(const std::vector<LinearStep>& steps, const Mission& mission,
                           Past past) {
  const double dt_s = mission.timing.dt_s;
  const Coefficients weights = sobolev_weights(mission.basis, mission.domain);
  // Covariances of δ and of the sums D_k = Σ g_ik δ_i.
  double variance = 0;
  Eigen::VectorXd with_sums = Eigen::VectorXd::Zero(weights.size());
  Eigen::MatrixXd of_sums = Eigen::MatrixXd::Zero(weights.size(), weights.size());
  std::vector<double> result = {0};
  for (const LinearStep& step : steps) {
    constexpr double kBeyondAnyDomain = 1e200;
    if (variance > kBeyondAnyDomain) {
      result.push_back(result.back());
      continue;
    }
    const double keep = 1 + step.rate_per_s * dt_s;
    if (past == Past::kNeglected || step.slopes.isZero(0)) {
      variance = keep * keep * variance + dt_s;
      with_sums *= keep;
    } else {
      const Eigen::VectorXd& g = step.slopes;
      of_sums.noalias() += g * (with_sums + 0.5 * variance * g).transpose();
      of_sums.noalias() += (with_sums + 0.5 * variance * g) * g.transpose();
      with_sums += variance * g;
      const Eigen::VectorXd pull = step.memory * weights.cwiseProduct(g);
      const Eigen::VectorXd sums_pulled = of_sums * pull;
      variance =
          keep * keep * variance - 2 * keep * pull.dot(with_sums) + pull.dot(sums_pulled) + dt_s;
      with_sums = keep * with_sums - sums_pulled;
    }
    result.push_back(std::sqrt(variance));
  }
  return result;
}

std::vector<double> deviation(const std::vector<LinearStep>& steps, const Mission& mission) {
  const double dt_s = mission.timing.dt_s;
  const Eigen::Vector2d normal = normal_of(mission).direction;
  const Coefficients weights = sobolev_weights(mission.basis, mission.domain);
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(weights.size());
  double off_m = 0;
  std::vector<double> result = {off_m};
  for (std::size_t j = 0; j < steps.size(); ++j) {
    const LinearStep& step = steps[j];
    sums += off_m * step.slopes;
    const double xi = normal.dot(normal_pair(mission.seed, Purpose::kPerturbation, 0, j));
    off_m += step.rate_per_s * dt_s * off_m -
             step.memory * sums.dot(weights.cwiseProduct(step.slopes)) +
             mission.law.noise_intensity * std::sqrt(dt_s) * xi;
    result.push_back(off_m);
  }
  return result;
}

}  // namespace ergocast::studies
