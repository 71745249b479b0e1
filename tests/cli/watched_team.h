// SPDX-License-Identifier: BSD-3-Clause
// A listener since 0 s, and the messages of a team of four that it receives.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "cli/team/team_view.h"
#include "tests/support/team.h"

namespace ergocast::test {

inline TeamStatus coordinator_at(Tick tick) {
  TeamStatus team;
  team.header = {kRun, kCoordinator, kCoordinatorLife, next_sequence(), tick};
  team.state = MissionState::kRunning;
  team.tick_count = 100;
  team.host = "base";
  return team;
}

class TeamViewTest : public ::testing::Test {
 protected:
  explicit TeamViewTest(const Mission& mission = small_mission(4)) : view_(kRun, at(0s)) {
    announce(mission);
  }

  void hear_mission(Instant now, std::vector<RosterEntry> roster = roster_of(4),
                    std::int64_t revision = 0, MissionState state = MissionState::kRunning,
                    std::string reason = "") {
    give(view_, mission_part(revision, state, std::move(roster), std::move(reason)), now);
  }
  void hear_processes(Instant now, Tick tick = 0) {
    give(view_, coordinator_at(tick), now);
    give(view_, world_state(tick, {{1, 1, 0}}), now);
    give(view_, RecordAck{{kRun, kLogger, kLoggerLife, next_sequence(), tick}}, now);
  }
  AgentStatus status(AgentId id, std::int64_t sequence, Tick tick = 0) const {
    AgentStatus status = status_of(id, sequence, tick);
    status.header.tick = tick;
    return status;
  }
  /// Every process sends, with the sequence numbers of that half second.
  void hear_all(Instant now, Tick tick = 0, AgentId but = kUnassigned) {
    hear_processes(now, tick);
    for (AgentId id = 0; id < 4; ++id) {
      if (id != but) give(view_, status(id, sequence_of(now), tick), now);
    }
  }
  static std::int64_t sequence_of(Instant now) { return 1 + now.time_since_epoch() / 1ms; }

  AgentRow row(AgentId id, Instant now) const {
    for (const AgentRow& row : view_.picture(now).agents) {
      if (row.author.agent == id) return row;
    }
    ADD_FAILURE() << "no row of agent " << id;
    return {};
  }
  Condition condition(AgentId id, Instant now) const { return row(id, now).condition; }

  TeamView view_;
};

}  // namespace ergocast::test
