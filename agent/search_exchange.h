// SPDX-License-Identifier: BSD-3-Clause
// Where the team has searched, as one agent knows it, and its exchange with teammates.
//
// Each 2 s of the mission the agent sends the tiles of its row that have changed, and with them
// older ones of its row in turn. It also repeats tiles of one other row, in turn: so the rows of
// stopped agents reach late joiners, without any request. In lockstep an agent waits for what
// teammates had to send by a tick, which does not depend on losses.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "agent/agent_step.h"
#include "core/base/ids.h"
#include "core/mission/amendments.h"
#include "core/mission/mission.h"
#include "core/mission/roster.h"
#include "core/search/efforts.h"
#include "team/author_map.h"
#include "team/messages.h"
#include "team/participant.h"
#include "team/radio_range.h"

namespace ergocast {

class SearchExchange {
 public:
  SearchExchange(const Mission& mission, const RosterEntry& self);

  const Efforts& efforts() const { return efforts_; }
  /// Takes in the newest list, of which sightings and dismissals count.
  void note(const Amendments& list) { efforts_.note(list.notes, list.holds); }

  /// The counted tick of `step` has come. The agent looks and notes what its sensor reports, if it
  /// covers, and sends what is due.
  /// @param covers  whether its time there counts
  void begin(const AgentStep& step, bool covers, Participant& me, Outbox& out);
  /// Sends again what it has sent last.
  void repeat(Participant& me, Outbox& out) const;

  /// Takes in tiles of a teammate, unless they are refused. Tiles from after the next halving wait
  /// for it: in lockstep they may come before the state of their tick.
  /// @param newest    the latest counted tick that the message can be of
  /// @param by_author  whether their author has sent them itself
  std::optional<Refusal> receive(const Effort& theirs, Tick newest, bool by_author);
  /// The first teammate in radio range whose tiles are due at `step` and missing; kUnassigned:
  /// none.
  AgentId awaited(const AgentStep& step, const RadioRange& radio, const Participant& me) const;

 private:
  /// What has arrived of the newest sending of a teammate.
  struct Arrived {
    Tick tick = -1;
    std::int32_t parts = 0;
    std::uint32_t missing = 0;  // a bit for each part
  };

  struct Early {
    Effort tiles;
    bool by_author;
  };

  Tick last_due(AgentId agent, Tick counted) const;
  std::optional<Refusal> merge(const Effort& theirs, bool by_author);
  void note_received(const Effort& theirs);
  void merge_early(Participant& me);
  void send_own(const AgentStep& step, Participant& me, Outbox& out);
  void relay_one_row(Tick counted, Participant& me, Outbox& out);
  /// Adds tiles of a row in turn, until the message is full.
  void fill(Effort& effort, const std::vector<EffortTile>& row, std::size_t& turn) const;

  Author self_;
  Efforts efforts_;
  Tick period_ticks_;
  Tick sent_at_ = -1;         // the counted tick of the last sending
  std::vector<Effort> sent_;  // its parts
  AuthorMap<Arrived> arrived_;
  std::vector<Early> early_;  // that wait for the next halving
  std::size_t own_turn_ = 0, row_turn_ = 0, tile_turn_ = 0;
};

}  // namespace ergocast
