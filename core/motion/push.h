// SPDX-License-Identifier: BSD-3-Clause
// What the world adds to a vehicle's step.
#pragma once

#include <Eigen/Core>
#include <span>

#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "core/mission/zones.h"

namespace ergocast {

/// The zones of a mission, and the vehicle's velocity at the end of the step.
struct AmongZones {
  std::span<const Zone> zones{};
  Eigen::Vector3d end_mps{0, 0, 0};
};

/// Where a vehicle at `x_m` with mean velocity `v_mps` is one step of `tick` later, edges not yet
/// considered: x + v dt + disturbance_intensity √dt ξ. Where a distance is kept, the last term is
/// cut to separation.disturbance_m; where there are walls, they and the edges stop it. So do zones
/// that bind the vehicle.
Eigen::Vector3d moved(const Mission& mission, AgentId id, Tick tick, const Eigen::Vector3d& x_m,
                      const Eigen::Vector3d& v_mps, const AmongZones& among = {});

}  // namespace ergocast
