// SPDX-License-Identifier: BSD-3-Clause
// The roster entry of an agent that an operator recalls. It changes once, and successors inherit
// the recall. No process takes the number of an agent that was sent out.
#include <gtest/gtest.h>

#include "tests/coordinator/driven_coordinator.h"

namespace ergocast {
namespace {

using namespace test;

Recall recall_of(AgentId agent, bool leaves = false, Tick tick = 0) {
  return {{kRun, kOperator, 1, next_sequence(), tick}, agent, leaves};
}

/// The entry of a number's present member, or of its last one.
RosterEntry newest(const Coordinator& coordinator, AgentId id) {
  RosterEntry found;
  for (const RosterEntry& entry : coordinator.roster()) {
    if (entry.author.agent == id && (found.author.agent != id || entry.active_until < 0))
      found = entry;
  }
  EXPECT_EQ(found.author.agent, id);
  return found;
}

std::int64_t revision_of(Coordinator& coordinator, Instant now) {
  const auto parts = only<MissionPart>(advance(coordinator, now));
  return parts.empty() ? -1 : parts[0].revision;
}

TEST(Recalling, WritesTheRevisionFromWhichTheAgentRests) {
  Coordinator coordinator = running_coordinator(small_mission(3));
  give(coordinator, recall_of(1), at(1s));
  const auto parts = only<MissionPart>(advance(coordinator, at(1s)));
  ASSERT_FALSE(parts.empty());
  const RosterEntry entry = newest(coordinator, 1);
  EXPECT_EQ(entry.recall_revision, parts[0].revision);
  EXPECT_FALSE(entry.leaves);
  EXPECT_TRUE(entry.recalled_at(parts[0].revision));
  EXPECT_FALSE(entry.recalled_at(parts[0].revision - 1));
  for (const AgentId other : {0, 2}) EXPECT_FALSE(newest(coordinator, other).recalled());
  EXPECT_EQ(parts[0].roster[1].recall_revision, entry.recall_revision) << "MISSION has it";
}

TEST(Recalling, HasAnEffectOnlyOnce) {
  Coordinator coordinator = running_coordinator(small_mission(3));
  give(coordinator, recall_of(1), at(1s));
  const std::int64_t revision = revision_of(coordinator, at(1s));
  give(coordinator, recall_of(1), at(1100ms));
  EXPECT_EQ(revision_of(coordinator, at(2100ms)), revision);
  EXPECT_EQ(newest(coordinator, 1).recall_revision, revision);
  give(coordinator, recall_of(1, true), at(2200ms));
  EXPECT_EQ(newest(coordinator, 1).recall_revision, revision) << "it rests since then";
  EXPECT_TRUE(newest(coordinator, 1).leaves);
  give(coordinator, recall_of(1), at(2300ms));
  EXPECT_TRUE(newest(coordinator, 1).leaves) << "it does not come back";
}

TEST(Recalling, NeedsAPresentMemberAndARunningMission) {
  Coordinator waiting = coordinator_of(small_mission(3));
  advance(waiting, at(0s));
  give(waiting, hello_of(1), at(0s));
  give(waiting, recall_of(1), at(0s));
  EXPECT_FALSE(newest(waiting, 1).recalled());
  Coordinator coordinator = running_coordinator(small_mission(3));
  const std::int64_t revision = revision_of(coordinator, at(1s));
  give(coordinator, recall_of(3), at(1s));
  EXPECT_EQ(revision_of(coordinator, at(2s)), revision);
}

TEST(Recalling, RefusesAnOldTick) {
  Mission mission = small_mission(3);
  mission.timing.tick_count = 10000;
  Coordinator coordinator = running_coordinator(mission);
  for (int second = 1; second < 21; ++second) {
    give(coordinator, world_where(second * 10, {9, 9, 9}), at(second * 1s));
    advance(coordinator, at(second * 1s));
  }
  give(coordinator, recall_of(1, false, 10), at(21s));
  EXPECT_FALSE(newest(coordinator, 1).recalled());
  EXPECT_EQ(coordinator.late_commands(), 1);
  give(coordinator, recall_of(1, false, 200), at(21s));
  EXPECT_TRUE(newest(coordinator, 1).recalled());
}

TEST(Recalling, HoldsForASuccessor) {
  Coordinator coordinator = running_coordinator(small_mission(3));
  give(coordinator, recall_of(1), at(1s));
  advance(coordinator, at(1s));
  give(coordinator, hello_of(1, 77), at(10s));  // the first one has been silent
  EXPECT_EQ(newest(coordinator, 1).author.incarnation, 77U);
  EXPECT_TRUE(newest(coordinator, 1).recalled());
}

TEST(Recalling, LeavesANumberEmpty) {
  Coordinator coordinator = running_coordinator(small_mission(3));
  give(coordinator, recall_of(1, true), at(1s));
  advance(coordinator, at(1s));
  advance(coordinator, at(10s));
  EXPECT_GE(newest(coordinator, 1).active_until, 0) << "it is silent, and its end may be lost";
  give(coordinator, hello_of(1, 77), at(10s));
  EXPECT_NE(newest(coordinator, 1).author.incarnation, 77U);
  EXPECT_EQ(coordinator.roster().size(), 3U);
}

TEST(Recalling, KeepsTheLastAgent) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  give(coordinator, recall_of(1, true), at(1s));
  give(coordinator, recall_of(0, true), at(1s));
  EXPECT_TRUE(newest(coordinator, 1).leaves);
  EXPECT_FALSE(newest(coordinator, 0).leaves);
  give(coordinator, recall_of(0), at(1s));
  EXPECT_TRUE(newest(coordinator, 0).recalled());
}

}  // namespace
}  // namespace ergocast
