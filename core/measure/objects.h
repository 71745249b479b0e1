// SPDX-License-Identifier: BSD-3-Clause
// The objects of the simulated world, and what sensors detect of them.
//
// They stand still: at the plan's places, or at places drawn from the target as core/measure/ knows
// it (target_mass.h), outside walls. A sensor within r of an object detects it in a tick with the
// probability 1 − exp(−γ dt), whatever is between (detection.h has r and γ). Places are a function
// of plan and seed, and detections of these, agent, tick and place. So worlds that restart,
// simulations and replays agree.
#pragma once

#include <vector>

#include "core/measure/finds.h"
#include "core/mission/mission.h"

namespace ergocast {

class Objects {
 public:
  Objects() = default;
  explicit Objects(const Mission& mission);

  /// By number.
  const std::vector<Eigen::Vector3d>& places_m() const { return places_m_; }
  /// What the sensor of an agent at `x_m` detects.
  ObjectSet detected(AgentId id, Tick tick, const Eigen::Vector3d& x_m) const;

 private:
  std::vector<Eigen::Vector3d> places_m_;
  std::uint64_t seed_ = 0;
  double radius_m_ = 0, probability_ = 0;  // of a detection in a tick
};

}  // namespace ergocast
