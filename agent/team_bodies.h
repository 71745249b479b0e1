// SPDX-License-Identifier: BSD-3-Clause
// Where the other bodies are, for the filter of commands: from the states of the world or, if only
// the agents know their positions, from teammates' beacons.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "agent/agent_step.h"
#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "core/mission/roster.h"
#include "core/motion/separation.h"
#include "team/beacon_book.h"
#include "team/messages.h"
#include "team/participant.h"
#include "team/state_assembler.h"

namespace ergocast {

class TeamBodies {
 public:
  /// @param self  the agent that needs them
  /// @param revision  of the roster in which it found itself
  TeamBodies(const Mission& mission, const Author& self, std::int64_t revision);

  /// Takes in which agents take part. No other call allocates memory for beacons.
  void note_roster(const std::vector<RosterEntry>& roster);
  void on(const WorldState& world) { states_.take(world); }
  /// @param fresh  no later message of its sender arrived before
  void on(const Beacon& beacon, bool fresh, const Moment& now);

  /// Takes in the own state at the beginning of `step`, and sends a beacon if one is due.
  void begin(const OwnState& own, const AgentStep& step, Participant& me, Outbox& out);
  /// Called when a command for `step` is sent.
  void answered(const AgentStep& step);

  /// Whether all positions of a tick have arrived. Beacons have ages, and are never waited for.
  bool complete(Tick tick) const { return beacons_ || states_.complete(tick); }
  /// All bodies, ascending by number, until the next call. Nothing if the world uses a newer roster
  /// than we know: it may have a body whose beacons we do not know.
  std::optional<std::span<const Neighbour>> neighbours(const AgentStep& step,
                                                       const Participant& me);

  /// The newest whole state of the world.
  const std::vector<WorldState>& states() const { return states_.states(); }
  /// Null if the mission uses no beacons.
  const BeaconBook* beacons() const { return beacons_ ? &*beacons_ : nullptr; }

 private:
  StateAssembler states_;
  std::optional<BeaconBook> beacons_;
};

}  // namespace ergocast
