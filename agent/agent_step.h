// SPDX-License-Identifier: BSD-3-Clause
// A tick of the world, as one agent takes part in it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "core/base/ids.h"
#include "core/basis/basis.h"
#include "core/motion/charge.h"
#include "core/search/search_cells.h"
#include "team/beacon_book.h"

namespace ergocast {

/// What a world's state has of the agent's own vehicle.
struct OwnState {
  Tick tick = -1;
  std::int64_t roster_revision = 0;  ///< the world's
  Tick answered_tick = -1;           ///< the newest whose command the vehicle had
  Eigen::Vector3d position_m{0, 0, 0}, velocity_mps{0, 0, 0};
  std::int32_t reported_cell = kNoCell;
  std::int32_t charge_ppm = kNoCharge;
};

/// The newest tick that the agent has begun.
struct AgentStep {
  Tick tick = -1;                    ///< −1: none yet
  Tick counted = -1;                 ///< its number among the ticks that count
  bool held = false;                 ///< the mission is paused: it does not count
  std::int64_t roster_revision = 0;  ///< the world's, at `tick`
  bool recalled = false;  ///< the operator has sent it home: it rests, core/mission/roster.h
  Instant begun{};
  Eigen::Vector3d x_m{0, 0, 0};     ///< the point of the domain nearest to body_m
  Eigen::Vector3d body_m{0, 0, 0};  ///< a robot may be outside of the domain
  Eigen::Vector3d body_mps{0, 0, 0};
  std::int32_t reported_cell = kNoCell;  ///< by its sensor
  std::int32_t charge_ppm = kNoCharge;   ///< of its vehicle
  std::optional<BasisAt> basis_at;       ///< at x_m

  Moment moment() const { return {tick, begun}; }
};

}  // namespace ergocast
