// SPDX-License-Identifier: BSD-3-Clause
// The objects of the simulated world, and what sensors detect of them.
//
// They begin at the plan's places, or at places drawn from the target as core/measure/ knows it
// (target_mass.h), outside walls. There they stand still, or drift from there (drift.h). A sensor
// within r of an object detects it in a tick with the probability 1 − exp(−γ dt), whatever is
// between (detection.h has r and γ). Places are a function of plan, seed and tick of the world, and
// detections of these, agent and place. So worlds that restart, simulations and replays agree.
#pragma once

#include <optional>
#include <vector>

#include "core/measure/drift.h"
#include "core/measure/finds.h"
#include "core/mission/mission.h"

namespace ergocast {

class Objects {
 public:
  Objects() = default;
  explicit Objects(const Mission& mission);

  /// By number, at the tick of the last move_to(), or where they begin.
  const std::vector<Eigen::Vector3d>& places_m() const { return places_m_; }
  /// Objects are where they are at a tick of the world. Ticks may come in any order.
  void move_to(Tick tick);
  /// What the sensor of an agent at `x_m` detects, after move_to(tick).
  ObjectSet detected(AgentId id, Tick tick, const Eigen::Vector3d& x_m);

 private:
  std::vector<Eigen::Vector3d> places_m_;
  std::optional<Drift> drift_;  // nothing: they stand still
  std::uint64_t seed_ = 0;
  double radius_m_ = 0, probability_ = 0;  // of a detection in a tick
};

}  // namespace ergocast
