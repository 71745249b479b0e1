// SPDX-License-Identifier: BSD-3-Clause
// Which end a running mission can still get in the place of the one that holds.
//
// A later end is named at least kEndNotice_s before the end that holds, so that no process has
// ended by then. An earlier end is possible if each agent with a station can still be there in
// time. The coordinator decides, and the operator's command explains; both use this class.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <span>

#include "core/base/ids.h"
#include "core/mission/amendments.h"
#include "core/mission/mission.h"
#include "core/motion/way_home.h"

namespace ergocast {

/// How long before the end that holds a later end is named, in mission time [s].
inline constexpr double kEndNotice_s = 10;

/// A present agent, and where its vehicle is if that is known.
struct AgentPlace {
  AgentId id;
  std::optional<Eigen::Vector3d> x_m;
};

enum class EndProblem {
  kNone,
  kSame,     ///< that end holds already
  kFull,     ///< the mission had kMaxEnds ends
  kPassed,   ///< that tick passes before all agents know the end
  kTooLate,  ///< a later end: the end that holds is less than kEndNotice_s away
  kTooFar,   ///< an agent cannot be at its station in time, or its place is not known
};

class EndRules {
 public:
  /// Why the mission cannot get an end of `tick_count` ticks.
  /// @param list  the newest list
  /// @param tick  the world's tick of the places
  /// @param from  the world's tick from which the end would hold; ≥ tick
  EndProblem problem(const Mission& mission, const Amendments& list, Tick tick, Tick from,
                     Tick tick_count, std::span<const AgentPlace> agents);
  /// The agent of the last kTooFar.
  AgentId too_far() const { return too_far_; }

 private:
  double needed_s(const Mission& mission, const AgentPlace& agent, const std::vector<Zone>& zones);

  std::map<AgentId, WayHome> ways_;  // of the agents that were asked for
  AgentId too_far_ = kUnassigned;
};

}  // namespace ergocast
