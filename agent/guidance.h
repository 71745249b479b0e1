// SPDX-License-Identifier: BSD-3-Clause
// The law, as one agent follows it: the coverage that it answers to, and the velocity that it wants
// there. The coverage is the forecast ĉ_k if the law looks ahead, else the known c_k. A law that
// needs none gets none.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "agent/agent_step.h"
#include "core/base/ids.h"
#include "core/law/coverage_table.h"
#include "core/law/forecast.h"
#include "core/law/law.h"
#include "core/law/target_shift.h"
#include "core/law/team_metric.h"
#include "core/mission/end_schedule.h"
#include "core/mission/law_change.h"
#include "core/mission/mission.h"
#include "core/mission/roster.h"
#include "team/messages.h"
#include "team/participant.h"
#include "team/radio_range.h"
#include "team/state_assembler.h"

namespace ergocast {

class Guidance {
 public:
  /// @param self  the agent's entry in the roster
  Guidance(const Mission& mission, const RosterEntry& self, const LawMaker& laws);

  /// Gives the forecast, and the law if it needs them, the positions of vehicles in range. In real
  /// time a vehicle stands still once its last answer is older than the world holds a command. In
  /// lockstep the world waits for answers.
  void on(const WorldState& world, const RadioRange& radio, const Participant& me);

  /// Takes in the end that holds at a counted tick.
  void note_ends(const Mission& mission, const EndSchedule& ends, Tick counted) {
    if (forecast_) forecast_->note_ends(mission, ends, counted);
  }

  /// Takes in the law and the target that hold at a tick of the world.
  void note_amendments(const Mission& mission, const Amendments& list, Tick tick);

  /// Whether a tick that counts can be computed: in lockstep, a command must not depend on the
  /// order in which the parts of the state arrive.
  bool has_state_of(Tick tick) const;

  /// The velocity that the law wants at a tick that counts.
  /// @param roster  in ticks that count
  /// @param shift  the changes of the target
  /// @param efforts  where the team has searched; null if the law does not search
  Eigen::Vector3d wanted_mps(const CoverageTable& table, const Efforts* efforts,
                             const std::vector<RosterEntry>& roster, const TargetShift& shift,
                             const AgentStep& step);
  /// Whether the law needs to know where the team has searched.
  bool searches() const { return needs_.search; }
  /// The coverage that wanted_mps() answered to.
  const Coefficients& foreseen() const { return foreseen_; }

  /// φ² of a coverage at a tick that counts.
  double metric(const Coefficients& coverage, const TargetShift& shift, Tick counted) const;

 private:
  void foresee(const CoverageTable& table, const std::vector<RosterEntry>& roster,
               const TargetShift& shift, const AgentStep& step);
  void note_places(const WorldState& world, const RadioRange& radio, const Box& domain);
  void set_team(const std::vector<RosterEntry>& roster, const AgentStep& step);
  void set_places(const AgentStep& step);

  AgentId id_;
  int kind_;
  Tick active_from_;
  std::unique_ptr<Law> law_;
  LawNumbers law_numbers_;  // of law_
  LawNeeds needs_;
  bool needs_state_;  // of the tick: places, or a forecast by dead reckoning
  TeamMetric metric_;
  std::int32_t newest_target_ = -1;
  std::vector<AgentId> team_;
  std::vector<TeamPlace> seen_;       // in the newest state of the world, ascending
  std::vector<TeamPlace> places_;     // of the team
  std::optional<Forecast> forecast_;  // if the law reads it
  ArrivedParts parts_;                // of the newest state of the world
  Coefficients foreseen_;
};

}  // namespace ergocast
