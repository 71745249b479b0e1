// SPDX-License-Identifier: BSD-3-Clause
// Flies a plan forwards through its residuals, and goes back through them with their adjoint.
#include "lab/studies/plans/plan_cost.h"

#include <algorithm>

#include "core/require.h"
#include "core/vectorized.h"

namespace ergocast::studies {
namespace {

constexpr int kLanes = 16;

/// Which share of a node is over at one of its places.
double share_at(int point, int points) { return (point + 0.5) / points; }

}  // namespace

PlanCost::PlanCost(const Mission& mission, const PlanSetting& setting)
    : mission_(mission),
      points_(setting.points),
      modes_(mission.basis.mode_count()),
      run_weight_(setting.run_weight),
      weights_(sobolev_weights(mission.basis, mission.domain)),
      residuals_(static_cast<std::size_t>(setting.nodes) * static_cast<std::size_t>(modes_)),
      factors_(static_cast<std::size_t>(setting.nodes)),
      adjoint_(static_cast<std::size_t>(modes_)) {
  places_.reserve(static_cast<std::size_t>(setting.nodes) *
                  static_cast<std::size_t>(setting.points));
}

double PlanCost::operator()(const Outlook& outlook, const Eigen::Vector3d& x_m, const Nodes& nodes,
                            Nodes& slope) {
  ERGOCAST_REQUIRE(outlook.durations_s.front() > 0);
  const int flown = fly(outlook, x_m, nodes);
  const double cost = weigh(outlook, flown);
  trace_back(outlook, flown, slope);
  return cost;
}

/// Sets places and W_h; returns how many nodes have τ > 0.
ERGOCAST_VECTORIZED
int PlanCost::fly(const Outlook& outlook, const Eigen::Vector3d& x_m, const Nodes& nodes) {
  Eigen::Vector3d at_m = x_m;
  const double* before = outlook.known_s.data();
  const double* target = mission_.target_coefficients.data();
  double wanted_s = outlook.covered_s;  // of μ; all of the past at the first node
  int flown = 0;
  places_.clear();
  for (; flown < nodes.cols(); ++flown) {
    const double duration_s = outlook.durations_s[static_cast<std::size_t>(flown)];
    if (duration_s <= 0) break;
    wanted_s += outlook.known_agents * duration_s;
    const double* others = outlook.others_s.data() + std::ptrdiff_t{flown} * modes_;
    double* residual = residual_of(flown);
    for (int k = 0; k < modes_; ++k) residual[k] = before[k] + others[k] - wanted_s * target[k];
    for (int point = 0; point < points_; ++point) {
      places_.emplace_back(at_m + share_at(point, points_) * duration_s * nodes.col(flown),
                           mission_.domain, mission_.basis);
      accumulate_basis(places_.back(), mission_.basis, duration_s / points_, residual);
    }
    at_m += duration_s * nodes.col(flown);
    before = residual;
    wanted_s = 0;
  }
  return flown;
}

/// J; sets the factors 2 (ω_h + [h = H]) / t_h².
ERGOCAST_VECTORIZED
double PlanCost::weigh(const Outlook& outlook, int flown) {
  double horizon_s = 0;
  for (int node = 0; node < flown; ++node)
    horizon_s += outlook.durations_s[static_cast<std::size_t>(node)];
  const double* weight = weights_.data();
  double covered_s = outlook.covered_s, cost = 0;
  for (int node = 0; node < flown; ++node) {
    const double duration_s = outlook.durations_s[static_cast<std::size_t>(node)];
    covered_s += outlook.known_agents * duration_s;
    const double* residual = residual_of(node);
    // Lanes in a fixed order: one chain of additions would cost more than all the rest.
    double partial[kLanes] = {};
    int k = 0;
    for (; k + kLanes <= modes_; k += kLanes) {
      for (int lane = 0; lane < kLanes; ++lane)
        partial[lane] += weight[k + lane] * residual[k + lane] * residual[k + lane];
    }
    for (; k < modes_; ++k) partial[0] += weight[k] * residual[k] * residual[k];
    double squares = 0;
    for (const double sum : partial) squares += sum;
    const double importance = run_weight_ * duration_s / horizon_s + (node + 1 == flown ? 1 : 0);
    cost += importance / (covered_s * covered_s) * squares;
    factors_[static_cast<std::size_t>(node)] = 2 * importance / (covered_s * covered_s);
  }
  return cost;
}

/// A node moves its own places by their share of it, and all later ones by all of it.
ERGOCAST_VECTORIZED
void PlanCost::trace_back(const Outlook& outlook, int flown, Nodes& slope) {
  slope.setZero();
  std::fill(adjoint_.begin(), adjoint_.end(), 0);
  double* adjoint = adjoint_.data();
  const double* weight = weights_.data();
  Eigen::Vector3d later(0, 0, 0);  // ∂J by a shift of all later places
  for (int node = flown - 1; node >= 0; --node) {
    const double factor = factors_[static_cast<std::size_t>(node)];
    const double duration_s = outlook.durations_s[static_cast<std::size_t>(node)];
    const double* residual = residual_of(node);
    for (int k = 0; k < modes_; ++k) adjoint[k] += factor * (weight[k] * residual[k]);
    slope.col(node) = duration_s * later;
    for (int point = 0; point < points_; ++point) {
      const auto at = std::ptrdiff_t{node} * points_ + point;
      const BasisAt& place = places_[static_cast<std::size_t>(at)];
      const Eigen::Vector3d here =
          duration_s / points_ * weighted_gradient(place, mission_.basis, adjoint);
      slope.col(node) += share_at(point, points_) * duration_s * here;
      later += here;
    }
  }
}

void add_gain(const Mission& mission, int points, const Eigen::Vector3d& x_m,
              const Eigen::Vector3d& v_mps, double duration_s, double* gain) {
  for (int point = 0; point < points; ++point) {
    const CosinesAt place(x_m + share_at(point, points) * duration_s * v_mps, mission.domain,
                          mission.basis);
    accumulate_basis(place, mission.basis, duration_s / points, gain);
  }
}

}  // namespace ergocast::studies
