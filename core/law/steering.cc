// SPDX-License-Identifier: BSD-3-Clause
// Draws noise by agent and tick, so that equal seeds give equal velocities.
#include "core/law/steering.h"

#include <algorithm>

#include "core/base/noise.h"
#include "core/base/portable_math.h"
#include "core/mission/kinds.h"

namespace ergocast {

Eigen::Vector3d smooth_input(const Eigen::Vector3d& spectral_gradient, double epsilon,
                             double u_max_mps) {
  // hypot, because B falls below 1e-4: its square would lose the smallest residuals.
  const double b_z = spectral_gradient.z();
  const double length =
      portable::hypot(portable::hypot(spectral_gradient.x(), spectral_gradient.y()),
                      b_z == 0 ? epsilon : portable::hypot(b_z, epsilon));
  if (length == 0) return {0, 0, 0};
  // The division comes first: u_max / length overflows where B is close to 0.
  return spectral_gradient / length * -u_max_mps;
}

Steering::Steering(const Mission& mission, int kind)
    : domain_(mission.domain),
      law_(law_of(mission, kind)),
      seed_(mission.seed),
      dt_s_(mission.timing.dt_s),
      scale_(law_, dt_s_),
      push_ticks_(push_ticks(law_, dt_s_)),
      pushes_(1) {}

void Steering::set_law(const LawNumbers& numbers) {
  if (numbers == LawNumbers{law_.u_max_mps, law_.noise_intensity, law_.noise_ceiling}) return;
  law_.u_max_mps = numbers.u_max_mps;
  law_.noise_intensity = numbers.noise_intensity;
  law_.noise_ceiling = numbers.noise_ceiling;
  scale_ = PerturbationScale(law_, dt_s_);
  push_ticks_ = push_ticks(law_, dt_s_);
}

Eigen::Vector3d Steering::velocity_mps(AgentId agent, Tick tick, const Eigen::Vector3d& x_m,
                                       const FieldAt& field, double epsilon) {
  Eigen::Vector3d velocity = smooth_input(field.gradient, epsilon, law_.u_max_mps) -
                             law_.contraction_gain_per_s * (x_m - law_.contraction_center_m);
  if (domain_.planar()) velocity.z() = 0;  // instead of −0
  if (law_.max_noise() > 0) {
    const Eigen::Vector3d xi =
        normal_in(domain_, seed_, Purpose::kPerturbation, static_cast<std::uint32_t>(agent),
                  static_cast<std::uint64_t>(tick));
    const Eigen::Vector3d eta = push(agent, tick / push_ticks_);
    velocity += perturbation(scale_, epsilon, field, xi, eta);
  }
  return velocity;
}

/// One agent alone needs one slot, whatever its number is. Others get theirs when they first need
/// one.
Steering::Push& Steering::slot_of(AgentId drawn) {
  const AgentId first = pushes_.front().drawn;
  if (pushes_.size() == 1 && (first == drawn || first == kUnassigned)) return pushes_.front();
  const std::size_t at = static_cast<std::uint32_t>(drawn) % kMostAgentsOfSites;
  pushes_.resize(std::max({pushes_.size(), at + 1, std::size_t{2}}));
  return pushes_[at];
}

/// η of one stretch of push_ticks_ ticks.
Eigen::Vector3d Steering::push(AgentId agent, Tick stretch) {
  const AgentId drawn = law_.paired_pushes ? agent - agent % 2 : agent;
  Push& last = slot_of(drawn);
  if (last.drawn != drawn || last.stretch != stretch) {
    last = {drawn, stretch,
            normal_in(domain_, seed_, Purpose::kPush, static_cast<std::uint32_t>(drawn),
                      static_cast<std::uint64_t>(stretch))};
  }
  return drawn == agent ? last.eta : Eigen::Vector3d(-last.eta);
}

}  // namespace ergocast
