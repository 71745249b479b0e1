// SPDX-License-Identifier: BSD-3-Clause
// Which end of the mission holds at which tick, and from when agents rest by it.
//
// The plan has tick_count ticks that count. An amendment may give the mission another number of
// ticks (EndChange). A process that has received it knows at once when the mission is over. What an
// agent computes, however, follows the end that holds at the tick, because its teammates may not
// know a later one yet.
//
// An agent with a station rests from R = tick_count − ⌈reserve_s / dt⌉ on, core/mission/station.h.
// An end that is named before R moves R. An agent that rests already stays at its station.
#pragma once

#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/mission/amendments.h"
#include "core/mission/hold.h"
#include "core/mission/mission.h"

namespace ergocast {

class EndSchedule {
 public:
  /// That of the plan.
  explicit EndSchedule(const Mission& mission) : plan_(mission.timing.tick_count) {}
  /// That of a list. @pre are_amendments(list, mission)
  EndSchedule(const Mission& mission, const Amendments& list) : EndSchedule(mission) { note(list); }
  EndSchedule(const Mission& mission, std::span<const Hold> holds, std::span<const EndChange> ends)
      : EndSchedule(mission) {
    note(holds, ends);
  }

  /// Takes in the newest list.
  void note(const Amendments& list) { note(list.holds, list.ends); }
  void note(std::span<const Hold> holds, std::span<const EndChange> ends);

  /// Whether the plan's end holds, and no other end is named.
  bool is_plans() const { return changes_.empty(); }
  /// The number of ticks by the newest end.
  Tick tick_count() const { return changes_.empty() ? plan_ : changes_.back().tick_count; }
  /// The number of ticks by the end that holds at a tick that counts, by its number among those.
  Tick tick_count_at(Tick counted) const;

  /// R of agent `id`, as the ends up to the one that holds at a counted tick have it; the greatest
  /// number if the agent has no station.
  Tick rest_from(const Mission& mission, AgentId id, Tick counted) const;
  /// Whether agent `id` rests at a tick, by its number among those that count.
  bool rests(const Mission& mission, AgentId id, Tick counted) const {
    return !mission.kinds.empty() && counted >= rest_from(mission, id, counted);
  }

 private:
  struct Change {
    Tick from;  // as numbered among those that count
    Tick tick_count;
  };
  Tick plan_;
  std::vector<Change> changes_;
};

}  // namespace ergocast
