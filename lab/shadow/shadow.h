// SPDX-License-Identifier: BSD-3-Clause
// What one agent has to forecast: ĉ of core/law/forecast.h, computed again by its equation from the
// messages that reached the agent.
//
// A shadow keeps the blocks and the places that its agent received. It does not use the forecast,
// its weights or the gains in the agent's table, so it does not repeat their errors.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <limits>
#include <map>
#include <optional>
#include <vector>

#include "core/base/ids.h"
#include "core/basis/basis.h"
#include "core/mission/mission.h"
#include "lab/shadow/table_view.h"
#include "lab/shadow/target_memory.h"
#include "lab/shadow/wire_modes.h"
#include "team/messages.h"

namespace ergocast::lab {

class Shadow {
 public:
  /// @param active_from  the agent's first tick, from its first admission. The first one counts
  /// even if it was lost with its coordinator; a later admission may name another tick.
  explicit Shadow(Tick active_from) : active_from_(active_from) {}
  Tick active_from() const { return active_from_; }

  /// The agent has received this list.
  void note_targets(const Mission& mission, const Amendments& list) {
    targets_.note(mission, list);
  }

  /// A message has reached the agent, whose state is now `agent`.
  void receive(const Mission& mission, const TableView& agent, const Message& message);

  /// The agent has answered a tick. Call it for each tick, because each adds places to the rows.
  void answer(const Mission& mission, const TableView& agent);

  /// How far the newest sample of the first block of its own row is from (f(x) − (μ − μ₀)) dt [s];
  /// 0 if the row has not gained exactly one step since the last call.
  double sample_error_s(const Mission& mission, const TableView& agent, const Eigen::Vector3d& x_m);

  /// ĉ at the tick that the agent has answered.
  Coefficients foreseen(const Mission& mission, const TableView& agent) const;

 private:
  /// Whether a teammate's battery is charged, and since when that is known.
  struct Charge {
    Tick tick = -1;
    bool goes_on = false;
  };
  struct Place {
    Tick tick;
    Eigen::Vector3d x_m;
  };
  struct Snapshot {
    std::int64_t steps = 0;
    Tick tick = 0, next_tick = 0;
    double elapsed_s = 0;
    BlockSums sums, gains;  ///< `gains` and their steps as the author has sent them
    std::int64_t gained_steps = 0;
  };
  struct Block {
    bool gains_possible = true;  ///< by the targets that the agent knew when `held` arrived
    Snapshot held,
        before;  ///< `before` is the previous one by steps, even if older blocks arrived later
    std::vector<Place> since;              ///< where its author was after `held`, as it was known
    std::int64_t dead_reckoned_steps = 0;  ///< steps of the block that `since` continues
  };
  struct Row {
    std::vector<Block> blocks;
    std::optional<Tick> active_from;  ///< of the admission that `since` and `newest` belong to
    std::optional<Place> newest;      ///< where its author was last
  };
  /// What one row adds to one block of ĉ.
  struct Part {
    std::vector<double> sums, gains;
    double time_s = 0, gained_s = 0;  ///< what they cover
    std::int64_t gained_steps = 0;    ///< 0: it has no forecast
    Tick tick = 0, period = 0;
    double quality = 1;
    Tick until = std::numeric_limits<Tick>::max();  ///< its author rests from then on
  };

  void take(const Mission& mission, const TableView& agent, const Contribution& theirs);
  bool gains_are_possible(const Mission& mission, const TableView& agent, const Block& block) const;
  void note_places(const Mission& mission, const TableView& agent, const WorldState& world);
  bool has_forecast(const Mission& mission, const TableView& agent, const RosterEntry& entry) const;
  bool in_range(const Mission& mission, AgentId one, AgentId other) const;
  static std::vector<Place> without_gaps(const std::deque<Place>& places, Tick active_from);
  void dead_reckon(const RosterEntry& entry, Row& row) const;
  Part part_of(const Mission& mission, const Block& block, Tick halvings) const;
  /// Adds `factor` times the shift of a tick.
  void add_shift(const Mission& mission, int block, Tick tick, double factor,
                 std::vector<double>& numbers) const;
  void correct_gains(const Mission& mission, int block, Tick tick, Part& part) const;
  std::vector<Part> parts_of(const Mission& mission, const Row& row, const RosterEntry* entry,
                             std::optional<Tick> forecast_tick, Tick halvings) const;
  std::vector<std::vector<Part>> team(const Mission& mission, const TableView& agent) const;

  /// The modes of the one mission that this shadow follows.
  const WireModes& modes(const Mission& mission) const;

  mutable WireModes modes_;
  mutable std::optional<Eigen::Matrix3d> covariance_m2_;  // of the target
  Tick active_from_;
  Tick newest_counted_ = 0;  // of the ticks that the agent has answered
  TargetMemory targets_;
  std::int64_t own_steps_ = -1;     // of the own row at the last call of sample_error_s(), …
  std::vector<double> own_sums_s_;  // … the sums of its first block, …
  Tick own_halvings_ = 0;           // … and how often they had been halved
  std::map<Author, Row> rows_;
  std::map<AgentId, Charge> charges_;
  std::map<AgentId, std::deque<Place>> places_;     // ascending by tick; the oldest are dropped
  std::map<AgentId, Eigen::Vector3d> positions_m_;  // for the radio range, of the newest …
  Tick positions_tick_ = -1;                        // … world state
};

}  // namespace ergocast::lab
