// SPDX-License-Identifier: BSD-3-Clause
// The final coverage of a team whose members were disconnected or stopped. Each member holds all
// coverage once, as its authors sent it.
#include <gtest/gtest.h>

#include "tests/agent/live_team.h"
#include "tests/support/bytes.h"

namespace ergocast {
namespace {

using namespace test;

/// The position of agent `id` at `tick`; no two agents and ticks have the same one.
Eigen::Vector3d place(AgentId id, Tick tick) {
  return {100.0 + 300.0 * id + 3.0 * static_cast<double>(tick),
          200.0 + 7.0 * static_cast<double>(tick), 0};
}

std::vector<Eigen::Vector3d> path_of(AgentId id, Tick from, Tick until) {
  std::vector<Eigen::Vector3d> path;
  for (Tick tick = from; tick < until; ++tick) path.push_back(place(id, tick));
  return path;
}

Mission realtime(int agents) {
  Mission mission = two_block_mission(agents);
  mission.timing.pace = Pace::kRealtime;
  mission.timing.tick_count = 1000;
  return mission;
}

/// The world's ticks [from, until), 0.1 s each; returns all messages of the team.
Outbox run_ticks(LiveTeam& team, int agents, Tick from, Tick until) {
  Outbox sent;
  for (Tick tick = from; tick < until; ++tick) {
    std::vector<Eigen::Vector3d> places;
    for (AgentId id = 0; id < agents; ++id) places.push_back(place(id, tick));
    for (Outgoing& word : team.deliver(world_state(tick, places), at(tick * 100ms))) {
      sent.push_back(std::move(word));
    }
  }
  return sent;
}

Coefficients average_of(const Mission& mission, const CoverageTable& table) {
  Coefficients average = Coefficients::Zero(mission.basis.mode_count());
  table.average(average);
  return average;
}

/// c_k of these incarnations, computed directly from their positions.
Coefficients average_of(
    const Mission& mission,
    const std::vector<std::pair<Author, std::vector<Eigen::Vector3d>>>& incarnations) {
  CoverageTable table(mission.basis, mission.timing.dt_s);
  for (const auto& [author, path] : incarnations) {
    for (const Contribution& block : blocks_of(mission, author, path, 0)) table.merge(block, 1000);
  }
  return average_of(mission, table);
}

TEST(Chain, BlocksReachAgentsThatCannotReceiveTheirAuthor) {
  const Mission mission = realtime(3);
  LiveTeam team(mission);
  team.set_receives([](AgentId a, AgentId b) { return std::abs(a - b) == 1; });
  run_ticks(team, 3, 0, 30);
  team.wait(at(3s), 3s);
  EXPECT_GT(status_after(team[1], at(6s)).contributions_relayed, 0);
  for (const AgentId end : {0, 2}) {
    const AgentId other = 2 - end;
    const auto held = team[end].coverage()->steps_held(author_of(other));
    ASSERT_GE(held.value_or(0), 28) << "30 ticks, and two broadcasts are tolerated";
    // The sums equal the other's, bit for bit.
    const auto words = blocks_of(mission, author_of(other), path_of(other, 0, *held), 0);
    for (int b = 0; b < 2; ++b) {
      EXPECT_EQ(team[end].coverage()->block(author_of(other), b).sums,
                words[static_cast<std::size_t>(b)].sums);
    }
  }
}

TEST(Chain, BlocksKeepUpWithAMissionThatIsFasterThanTheClock) {
  const Mission mission = realtime(3);
  LiveTeam team(mission);
  team.set_receives([](AgentId a, AgentId b) { return std::abs(a - b) == 1; });
  for (Tick tick = 0; tick < 200; ++tick) {
    team.deliver(world_state(tick, {place(0, tick), place(1, tick), place(2, tick)}), at(0s));
    if (tick < 25) continue;
    // A digest comes each 10 ticks, the second one begins a repair, and an answer comes within 3.
    EXPECT_GE(team[0].coverage()->steps_held(author_of(2)).value_or(0), tick - 15) << tick;
  }
}

TEST(Chain, WhatIsPassedOnIsWhatItsAuthorSentByteForByte) {
  const Mission mission = realtime(3);
  LiveTeam team(mission);
  team.set_receives([](AgentId a, AgentId b) { return std::abs(a - b) == 1; });
  Outbox sent = run_ticks(team, 3, 0, 30);
  for (Outgoing& word : team.wait(at(3s), 3s)) sent.push_back(std::move(word));
  std::map<std::pair<std::int64_t, std::int32_t>, std::vector<std::byte>> original;
  int passed_on = 0;
  for (const Outgoing& word : sent) {
    const auto* block = std::get_if<Contribution>(&word.message);
    if (block == nullptr || block->header.sender != 2) continue;
    const auto key = std::pair(block->steps, block->block);
    if (word.relayer == kUnassigned) {
      original.emplace(key, bytes_of(*block));
    } else {
      EXPECT_EQ(word.relayer, 1) << "only agent 1 has received it";
      EXPECT_EQ(word.bus, Bus::kSwarm);
      ASSERT_TRUE(original.contains(key));
      EXPECT_EQ(bytes_of(*block), original[key]);
      ++passed_on;
    }
  }
  EXPECT_GE(passed_on, 4) << "two rows or more, in two blocks";
}

TEST(Partition, HalvesThatMeetAgainCountEverythingOnce) {
  const Mission mission = realtime(4);
  LiveTeam team(mission);
  team.set_receives([](AgentId a, AgentId b) { return a / 2 == b / 2; });
  run_ticks(team, 4, 0, 20);
  EXPECT_EQ(team[0].coverage()->row_count(), 2u) << "its half";
  // 3 stops when only 2 has received its blocks; then the halves meet.
  team.kill(3);
  auto roster = roster_of(4);
  roster[3].active_until = 20;
  team.deliver(mission_part(1, MissionState::kRunning, roster), at(2s));
  team.set_receives([](AgentId, AgentId) { return true; });
  run_ticks(team, 4, 20, 22);
  team.wait(at(2200ms), 3s);

  std::vector<std::pair<Author, std::vector<Eigen::Vector3d>>> incarnations;
  for (AgentId id = 0; id < 4; ++id) {
    incarnations.emplace_back(author_of(id), path_of(id, 0, id == 3 ? 20 : 22));
  }
  const Coefficients everything = average_of(mission, incarnations);
  for (AgentId id = 0; id < 3; ++id) {
    EXPECT_EQ(team[id].coverage()->row_count(), 4u);
    EXPECT_EQ(average_of(mission, *team[id].coverage()), everything) << "bit for bit, agent " << id;
  }
}

TEST(Restart, AnAgentGetsItsFormerIncarnationsBackFromATeammate) {
  const Mission mission = realtime(2);
  const Author former = author_of(0), restarted{0, 99};
  LiveTeam team(mission);
  run_ticks(team, 2, 0, 20);
  team.kill(0);
  const MissionPart news = mission_part(
      1, MissionState::kRunning, {{former, 0, 20}, {restarted, 20, -1}, {author_of(1), 0, -1}});
  AgentIdentity identity = identity_of(0);
  identity.incarnation = restarted.incarnation;
  team.revive(0, Agent(identity));
  team.deliver(news, at(2s));
  EXPECT_EQ(team[0].coverage()->steps_held(former), std::nullopt);
  run_ticks(team, 2, 20, 25);
  team.wait(at(2500ms), 3s);

  EXPECT_EQ(team[0].coverage()->steps_held(former), 20);
  EXPECT_EQ(team[0].coverage()->steps_held(restarted), 5) << "never added into its new sum";
  const Coefficients everything = average_of(mission, {{former, path_of(0, 0, 20)},
                                                       {restarted, path_of(0, 20, 25)},
                                                       {author_of(1), path_of(1, 0, 25)}});
  for (const AgentId id : {0, 1}) {
    EXPECT_EQ(average_of(mission, *team[id].coverage()), everything) << "agent " << id;
  }
}

TEST(LostBroadcast, IsRepairedByATeammateThatReceivedIt) {
  // In real time the next broadcast repairs a loss anyway, but an agent's last broadcast has no
  // next one.
  const Mission mission = realtime(3);
  LiveTeam team(mission);
  run_ticks(team, 3, 0, 10);
  team.set_receives(
      [](AgentId listener, AgentId transmitter) { return listener != 0 || transmitter != 2; });
  run_ticks(team, 3, 10, 11);
  team.kill(2);
  auto roster = roster_of(3);
  roster[2].active_until = 11;
  team.deliver(mission_part(1, MissionState::kRunning, roster), at(1100ms));
  EXPECT_EQ(team[0].coverage()->steps_held(author_of(2)), 10);
  team.wait(at(1100ms), 3s);
  EXPECT_EQ(team[0].coverage()->steps_held(author_of(2)), 11);
}

}  // namespace
}  // namespace ergocast
