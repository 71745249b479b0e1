// SPDX-License-Identifier: BSD-3-Clause
// The interface of a physics engine that moves the bodies of a world in place of the kinematics of
// core/motion/vehicle.h. Its vehicles may follow late, slip and touch each other.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/mission/mission.h"

namespace ergocast {

/// One body in one tick.
struct PhysicalBody {
  AgentId id = kUnassigned;
  Eigen::Vector3d wanted_mps{0, 0, 0};  ///< the command; 0: stand still
  // The result, at the end of the tick:
  Eigen::Vector3d position_m{0, 0, 0};
  Eigen::Vector3d velocity_mps{0, 0, 0};
};

class Physics {
 public:
  virtual ~Physics() = default;

  /// Puts a new or known body at `position_m`, where it moves with `velocity_mps`.
  virtual void place(AgentId id, const Eigen::Vector3d& position_m,
                     const Eigen::Vector3d& velocity_mps) = 0;

  /// Simulates one tick of the mission and writes its result into `bodies`: all that were placed,
  /// in ascending order. The result depends only on the calls so far, not on a clock or on chance.
  virtual void pass_tick(std::span<PhysicalBody> bodies) = 0;

  /// A few words for the log at the end; may be empty.
  virtual std::string summary() const { return {}; }
};

/// Makes the physics of a mission, or returns why it cannot, with the remedy.
using PhysicsMaker = std::function<Result<std::unique_ptr<Physics>>(const Mission&)>;

}  // namespace ergocast
