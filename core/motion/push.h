// SPDX-License-Identifier: BSD-3-Clause
// What the world adds to a vehicle's step.
#pragma once

#include <Eigen/Core>

#include "core/base/ids.h"
#include "core/mission/mission.h"

namespace ergocast {

/// Where a vehicle at `x_m` with mean velocity `v_mps` is one step of `tick` later, edges not yet
/// considered: x + v dt + disturbance_intensity √dt ξ. Where a distance is kept, the last term is
/// cut to separation.disturbance_m; where there are walls, they and the edges stop it.
Eigen::Vector3d moved(const Mission& mission, AgentId id, Tick tick, const Eigen::Vector3d& x_m,
                      const Eigen::Vector3d& v_mps);

}  // namespace ergocast
