// SPDX-License-Identifier: BSD-3-Clause
// Agent 0 of a team with prepared messages of its teammates, to time how it processes them.
#pragma once

#include <vector>

#include "core/law/control.h"
#include "core/law/coverage_table.h"
#include "core/law/forecast.h"
#include "core/mission/mission.h"

namespace ergocast::bench {

/// The coverage that agent 0 uses, and its source.
enum class Sight {
  kKnown,            ///< c, of rows broadcast each tick
  kToldEachTick,     ///< ĉ, of rows broadcast each tick
  kToldEach10Ticks,  ///< ĉ, of rows broadcast every ten ticks, in turns
  kReckoned,         ///< likewise, with the teammates' places
};

class StepTeam {
 public:
  /// @param free_domain  uses the modes of a free domain without walls, as many as cosines
  StepTeam(int modes_per_axis, int agents, Sight sight, bool free_domain = false);

  const Mission& mission() const { return mission_; }
  Tick tick() const { return tick_; }
  /// The positions of all agents at tick(), agent 0 first.
  const std::vector<Eigen::Vector3d>& places_m() const { return places_m_; }
  /// Every block that teammates send at tick().
  const std::vector<Contribution>& news() const { return news_; }

  /// The next tick: all agents move; the teammates add their samples and prepare their messages.
  void teammates_step();
  /// Agent 0 receives the teammates' messages and the positions of all agents.
  void merge_news();
  /// Agent 0's work between receiving its position and sending its command.
  Eigen::Vector3d step();

 private:
  Mission mission_;
  CoverageTable own_;
  Controller controller_;
  Forecast forecast_;
  Coefficients coverage_;
  std::vector<RosterEntry> roster_;
  std::vector<CoverageTable> teammates_;
  std::vector<Contribution> news_;
  std::vector<Eigen::Vector3d> places_m_;
  Tick tick_ = -1;
};

}  // namespace ergocast::bench
