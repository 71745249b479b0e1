// SPDX-License-Identifier: BSD-3-Clause
// What agents know of where the team has searched: with losses, over relays, after deaths.
#include <gtest/gtest.h>

#include "core/base/noise.h"
#include "tests/agent/live_team.h"

namespace ergocast {
namespace {

using namespace test;

constexpr int kTeam = 3;

Mission searching() {
  Mission mission = two_block_mission(kTeam);
  mission.timing.pace = Pace::kRealtime;
  mission.timing.tick_count = 100000;
  mission.law.kind = LawKind::kSearch;
  mission.law.anticipation = 0;
  return mission;
}

/// Agents go along a line for 60 s. Then each stays where it is.
Eigen::Vector3d place(const Mission& mission, AgentId id, Tick tick) {
  const Eigen::Vector3d& size_m = mission.domain.size_m;
  const double along = static_cast<double>(std::min<Tick>(tick, 600)) / 700;
  return mission.domain.origin_m +
         Eigen::Vector3d(along * size_m.x(), size_m.y() * (0.2 + 0.3 * id + 0.1 * along), 0);
}

void run_ticks(LiveTeam& team, const Mission& mission, Tick from, Tick until) {
  for (Tick tick = from; tick < until; ++tick) {
    std::vector<Eigen::Vector3d> places_m;
    for (AgentId id = 0; id < kTeam; ++id) places_m.push_back(place(mission, id, tick));
    team.deliver(world_state(tick, places_m), at(tick * 100ms));
  }
}

/// What a row has, if there was no loss at all.
Efforts expected(const Mission& mission, Tick until) {
  Efforts efforts(mission);
  for (AgentId id = 0; id < kTeam; ++id) {
    efforts.add_row(author_of(id));
    for (Tick tick = 0; tick < until; ++tick)
      efforts.look(author_of(id), tick, place(mission, id, tick));
  }
  return efforts;
}

/// In how many cells an agent knows another number of looks of an author.
int wrong_cells(const Efforts& known, const Efforts& right, const Author& author) {
  const std::vector<EffortTile>& wanted = *right.row_of(author);
  const std::vector<EffortTile>* const held = known.row_of(author);
  int wrong = 0;
  for (std::size_t tile = 0; tile < wanted.size(); ++tile) {
    for (std::size_t slot = 0; slot < kTileCells; ++slot)
      wrong += wanted[tile].looks[slot] != (held == nullptr ? 0 : (*held)[tile].looks[slot]);
  }
  return wrong;
}

TEST(SearchExchange, EveryAgentKnowsAllLooksInTheEndWhateverWasLost) {
  const Mission mission = searching();
  LiveTeam team(mission);
  std::uint64_t drawn = 0;
  team.set_receives(
      [&](AgentId, AgentId) { return uniform_pair(1, Purpose::kFault, 0, ++drawn).x() > 0.5; });
  run_ticks(team, mission, 0, 1500);
  const Efforts right = expected(mission, 1500);
  for (AgentId id = 0; id < kTeam; ++id) {
    for (AgentId author = 0; author < kTeam; ++author)
      EXPECT_EQ(wrong_cells(*team[id].efforts(), right, author_of(author)), 0)
          << id << " of " << author;
  }
}

TEST(SearchExchange, LooksReachAgentsThatCannotReceiveTheirAuthor) {
  const Mission mission = searching();
  LiveTeam team(mission);
  team.set_receives([](AgentId a, AgentId b) { return std::abs(a - b) == 1; });
  run_ticks(team, mission, 0, 1500);
  EXPECT_EQ(wrong_cells(*team[2].efforts(), expected(mission, 1500), author_of(0)), 0);
}

TEST(SearchExchange, LooksOfAStoppedAgentReachAnotherThatComesLater) {
  const Mission mission = searching();
  LiveTeam team(mission);
  // Agent 0 sends at tick 280, and is then stopped. Agent 2 is started anew.
  run_ticks(team, mission, 0, 281);
  team.kill(0);
  const Efforts right = expected(mission, 281);
  ASSERT_EQ(wrong_cells(*team[1].efforts(), right, author_of(0)), 0);
  team.kill(2);
  team.revive(2, running_agent(mission, 2));
  ASSERT_GT(wrong_cells(*team[2].efforts(), right, author_of(0)), 0);
  run_ticks(team, mission, 281, 900);
  EXPECT_EQ(wrong_cells(*team[2].efforts(), right, author_of(0)), 0);
}

/// In lockstep an author may be a tick ahead: its tiles are from after a halving that is to come.
TEST(SearchExchange, TilesFromAfterTheNextHalvingWaitForIt) {
  Mission mission = searching();
  mission.law.memory_half_life_s = 5;
  const auto halving = static_cast<Tick>(5 / mission.timing.dt_s);
  LiveTeam team(mission);
  run_ticks(team, mission, 0, halving);
  const std::size_t last = team[1].efforts()->cells().tile_count() - 1;
  Effort early;
  early.header = {kRun, 0, author_of(0).incarnation, 1000, halving};
  early.parts = 1;
  early.tile_count = 1;
  early.tiles[0].number = static_cast<std::int32_t>(last);
  early.tiles[0].content.newest_look = halving;
  early.tiles[0].content.looks[0] = 1;
  ASSERT_EQ(team[1].efforts()->looks({last, 0}), 0u);
  give(team[1], early, at((halving - 1) * 100ms), 0);
  EXPECT_EQ(team[1].efforts()->looks({last, 0}), 0u) << "the halving has not come";
  run_ticks(team, mission, halving, halving + 1);
  EXPECT_EQ(team[1].efforts()->looks({last, 0}), 1u);
}

/// In lockstep agents wait for what teammates have to send, but not for what nobody will send.
TEST(SearchExchange, ForgedPartsStallNobody) {
  Mission mission = searching();
  mission.timing.pace = Pace::kLockstep;
  for (const Tick forged_tick : {Tick{0}, Tick{30}}) {
    LiveTeam team(mission);
    run_ticks(team, mission, 0, 1);
    Effort forged;
    forged.header = {kRun, 0, author_of(0).incarnation, 1000, forged_tick};
    forged.parts = kMaxEffortParts;
    give(team[1], forged, at(50ms), 0);
    run_ticks(team, mission, 1, 60);
    EXPECT_EQ(team[1].tick(), 59);
    EXPECT_EQ(status_after(team[1], at(7s)).answered_tick, 59) << forged_tick;
  }
}

TEST(SearchExchange, ForgedRowsAreRefusedAndHaveNoEffect) {
  const Mission mission = searching();
  LiveTeam team(mission);
  run_ticks(team, mission, 0, 20);
  Effort forged;
  forged.header = {kRun, 0, author_of(0).incarnation, 1000, 1000000};
  forged.tile_count = 1;
  forged.tiles[0].content.newest_look = 5;
  give(team[1], forged, at(2s), 0);
  forged.header.tick = 19;
  forged.tiles[0].number = static_cast<std::int32_t>(kMaxTiles) - 1;
  give(team[1], forged, at(2s), 0);
  forged.tiles[0].number = 0;
  forged.tiles[0].content.looks[0] = 60000;
  give(team[1], forged, at(2s), 0);
  EXPECT_EQ(team[1].refused()[static_cast<std::size_t>(Refusal::kRange)], 3);
  EXPECT_EQ(team[1].efforts()->looks({0, 0}), 0u);
}

}  // namespace
}  // namespace ergocast
