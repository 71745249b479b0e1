// SPDX-License-Identifier: BSD-3-Clause
// What a running team shows in ROS 2: coverage, target, ways, φ² and status. No clock, no I/O.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cli/team/team_view.h"
#include "core/measure/detection.h"
#include "core/measure/occupancy.h"
#include "core/measure/thinned_path.h"
#include "core/mission/kinds.h"
#include "core/mission/mission.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast::ros2 {

class Display {
 public:
  static constexpr Role kRole = Role::kMonitor;

  /// @param run  0: the first one received
  Display(RunId run, Instant since, bool authenticated);

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);

  /// Whether the mission is known, so that there is something to show.
  bool begun() const { return mission_.has_value(); }
  bool over() const { return view_ && view_->over(); }
  const Box& domain() const { return mission_->domain; }

  /// Where the team has been: the density of time since this display began, in the mission's
  /// cosines. Empty before the first position. @pre begun()
  OccupancyGrid coverage() const;
  /// The target that holds now. @pre begun()
  OccupancyGrid target() const;
  /// occupancy_left() since this display and the target began. @pre begun()
  OccupancyGrid left() const;
  /// Changes whenever target() does.
  std::int32_t target_number() const;
  const std::map<AgentId, ThinnedPath>& paths() const { return paths_; }
  /// Median of the agents' values, and one line about the team. @pre begun()
  struct Status {
    std::optional<double> ergodic_metric;
    std::optional<double> found;  ///< P of core/measure/detection.h, as a logger reports it
    std::vector<Eigen::Vector3d> finds_m, contacts_m;
    std::string text;
  };
  Status status(Instant now) const;

 private:
  static constexpr std::int32_t kNoTarget = -2;

  void on(const WorldState& world);
  const Coefficients& present_target() const;

  RunId run_;
  Instant since_;
  bool authenticated_;
  std::optional<Participant> me_;
  std::optional<TeamView> view_;
  std::optional<Mission> mission_;  // in cosines
  Sensors sensors_;
  Detection detection_;
  std::int32_t detected_target_ = kNoTarget;  // the one of `detection_`
  Coefficients sums_;
  double samples_ = 0;  // each weighted by its quality
  Tick tick_ = 0;
  std::map<AgentId, Tick> newest_;  // the tick of each agent's last sample
  std::map<AgentId, ThinnedPath> paths_;
};

}  // namespace ergocast::ros2
