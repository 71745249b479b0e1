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
#include "core/mission/kinds.h"
#include "core/mission/mission.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast::ros2 {

/// Square cells from a corner of the domain, as nav_msgs/OccupancyGrid has them.
struct Grid {
  double resolution_m = 1;
  std::uint32_t width = 0, height = 0;  ///< along x and y
  /// The cell (i along x, j along y) is at j · width + i: 100 for the target's greatest density,
  /// −1 outside of the domain.
  std::vector<std::int8_t> data;
};

class Display {
 public:
  static constexpr Role kRole = Role::kMonitor;
  /// Limit (ROS 2): positions of one agent's path. Beyond it: every second one is left out.
  static constexpr std::size_t kMostPositions = 500;
  /// Cells along the domain's longer side.
  static constexpr int kCells = 64;

  /// @param run  0: the first one received
  Display(RunId run, Instant since, bool authenticated);

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);

  /// Whether the mission is known, so that there is something to show.
  bool begun() const { return mission_.has_value(); }
  bool over() const { return view_ && view_->over(); }
  const Box& domain() const { return mission_->domain; }

  /// Where the team has been: the density of time since this display began, in the mission's
  /// cosines. Empty before the first position. @pre begun()
  Grid coverage() const;
  /// The target that holds now. @pre begun()
  Grid target() const;
  /// How much of the target an object may still be in: the target times the probability that no
  /// sensor of the team has detected an object there since this display and the target began.
  /// @pre begun()
  Grid left() const;
  /// Changes whenever target() does.
  std::int32_t target_number() const;
  const std::map<AgentId, std::vector<Eigen::Vector3d>>& paths_m() const { return paths_m_; }
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
  void detect(const WorldState& world);
  const Coefficients& present_target() const;
  Grid grid_of(const Coefficients& coefficients) const;
  void add_position(AgentId id, const Eigen::Vector3d& at_m);

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
  std::map<AgentId, std::vector<Eigen::Vector3d>> paths_m_;
  std::map<AgentId, std::pair<std::size_t, std::size_t>> strides_;  // every how many, how many
};

}  // namespace ergocast::ros2
