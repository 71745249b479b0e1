// SPDX-License-Identifier: BSD-3-Clause
// What moves the bodies of a world, in the place of the kinematics of core/vehicle.h: a physics
// engine, for instance, whose vehicles follow late, slip and touch each other.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <variant>

#include "core/ids.h"
#include "core/mission.h"

namespace ergocast {

/// One body in one tick.
struct PhysicalBody {
  AgentId id = kUnassigned;
  Eigen::Vector3d wanted_mps{0, 0, 0};  ///< the command; 0: it is to stand
  // What comes of it, at the tick's end:
  Eigen::Vector3d position_m{0, 0, 0};
  Eigen::Vector3d velocity_mps{0, 0, 0};
};

class Physics {
 public:
  virtual ~Physics() = default;

  /// Puts a body there, new or known, that moves with `velocity_mps` from then on.
  virtual void place(AgentId id, const Eigen::Vector3d& position_m,
                     const Eigen::Vector3d& velocity_mps) = 0;

  /// Lets a tick of the mission pass, and says where it has led each of `bodies`: all that were
  /// placed, in ascending order. A function of all calls before it: no clock, no chance.
  virtual void pass_tick(std::span<PhysicalBody> bodies) = 0;

  /// What there is to say at the end, in a few words; empty: nothing.
  virtual std::string summary() const { return {}; }
};

/// Makes the physics of a mission; or says why it cannot, and the remedy.
using PhysicsMaker =
    std::function<std::variant<std::unique_ptr<Physics>, std::string>(const Mission&)>;

}  // namespace ergocast
