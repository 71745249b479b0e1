// SPDX-License-Identifier: BSD-3-Clause
// Copies each Protobuf block into the plain type of the same meaning.
#include "scenario/convert.h"

#include <cmath>

namespace ergocast {
namespace {

Eigen::Matrix2d covariance_of(const proto::Gaussian& gaussian) {
  if (gaussian.has_sigma_m()) {
    return gaussian.sigma_m() * gaussian.sigma_m() * Eigen::Matrix2d::Identity();
  }
  const proto::Covariance& c = gaussian.covariance();
  Eigen::Matrix2d matrix;
  matrix << c.xx_m2(), c.xy_m2(), c.xy_m2(), c.yy_m2();
  return matrix;
}

template <class Vertices>
Ring ring_of(const Vertices& vertices) {
  Ring ring;
  for (const proto::Vertex& vertex : vertices) ring.emplace_back(vertex.x_m(), vertex.y_m());
  return ring;
}

Eigen::Vector3d contraction_center_of(const proto::Law& law, const Box& domain) {
  switch (law.contraction_center()) {
    case proto::Law::COORDINATE_ORIGIN:
      return {0, 0, 0};
    case proto::Law::POINT:
      return {law.contraction_x_m(), law.contraction_y_m(), 0};
    default:
      return domain.center_m();
  }
}

}  // namespace

Box domain_of(const proto::Domain& domain) {
  return {{domain.origin_x_m(), domain.origin_y_m(), 0}, {domain.size_x_m(), domain.size_y_m(), 0}};
}

Polygon polygon_of(const proto::Polygon& polygon) {
  Polygon plain{ring_of(polygon.vertices()), {}};
  for (const proto::Ring& hole : polygon.holes()) plain.holes.push_back(ring_of(hole.vertices()));
  return plain;
}

Rectangle extent_of(const proto::Map& map) {
  return {{map.origin_x_m(), map.origin_y_m()}, {map.size_x_m(), map.size_y_m()}};
}

TargetDensity target_of(const proto::Target& target) {
  TargetDensity density;
  density.uniform_weight = target.uniform_weight();
  for (const proto::Gaussian& gaussian : target.gaussians()) {
    density.gaussians.push_back(
        {gaussian.weight(), {gaussian.mean_x_m(), gaussian.mean_y_m()}, covariance_of(gaussian)});
  }
  for (const proto::Region& region : target.regions()) {
    density.regions.push_back({region.weight(), polygon_of(region.polygon())});
  }
  for (const proto::Polygon& keep_out : target.keep_outs()) {
    density.keep_outs.push_back(polygon_of(keep_out));
  }
  return density;
}

Basis basis_of(const proto::Basis& basis) {
  return {.modes_x = basis.modes_x(),
          .modes_y = basis.modes_y(),
          .sobolev_form = basis.sobolev_form() == proto::Basis::NORM ? SobolevForm::kNorm
                                                                     : SobolevForm::kSquaredNorm,
          .sobolev_exponent = basis.sobolev_exponent(),
          .normalized = basis.normalized()};
}

ControlLaw law_of(const proto::Law& law, const Box& domain) {
  return {.u_max_mps = law.u_max_mps(),
          .regularization = law.regularization() == proto::Law::ABSOLUTE
                                ? Regularization::kAbsolute
                                : Regularization::kRelative,
          .epsilon = law.epsilon(),
          .perturbation = law.perturbation() == proto::Law::CONSTANT ? Perturbation::kConstant
                                                                     : Perturbation::kAdaptive,
          .noise_intensity = law.noise_intensity(),
          .noise_ceiling = law.noise_ceiling(),
          .contraction_gain_per_s = law.contraction_gain_per_s(),
          .contraction_center_m = contraction_center_of(law, domain),
          .anticipation = law.anticipation(),
          .ends_with_plan = law.ends_with_plan(),
          .paired_pushes = law.paired_pushes()};
}

Timing timing_of(const proto::Time& time) {
  return {.dt_s = time.dt_s(),
          .tick_count = std::llround(time.duration_s() / time.dt_s()),
          .broadcast_period_ticks = time.broadcast_period_ticks(),
          .pace = time.pace() == proto::Time::REALTIME ? Pace::kRealtime : Pace::kLockstep,
          .realtime_factor = time.realtime_factor(),
          .lockstep_timeout_s = time.lockstep_timeout_s(),
          .command_hold_s = time.command_hold_s(),
          .admission_timeout_s = time.admission_timeout_s(),
          .catch_up_limit_ticks = time.catch_up_limit_ticks(),
          .on_timeout =
              time.on_timeout() == proto::Time::EVICT ? OnTimeout::kEvict : OnTimeout::kEndMission};
}

Mission mission_of(const proto::Scenario& scenario) {
  Mission mission;
  mission.name = scenario.name();
  mission.seed = scenario.seed();
  mission.domain = domain_of(scenario.domain());
  mission.basis = basis_of(scenario.basis());
  mission.law = law_of(scenario.law(), mission.domain);
  mission.timing = timing_of(scenario.time());
  for (const proto::Start& start : scenario.agents().starts()) {
    mission.starts_m.emplace_back(start.x_m(), start.y_m(), 0);
  }
  mission.quorum = scenario.agents().quorum();
  mission.forget_silent_after_s = scenario.agents().forget_silent_after_s();
  mission.dead_reckoning = scenario.agents().dead_reckoning();
  mission.goal_ergodic_metric = scenario.goal_ergodic_metric();
  mission.radio_range_m = scenario.world().radio_range_m();
  mission.disturbance_intensity = scenario.world().disturbance_intensity();
  mission.speed_limit_mps = scenario.world().speed_limit_mps();
  return mission;
}

}  // namespace ergocast
