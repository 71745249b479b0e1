// SPDX-License-Identifier: BSD-3-Clause
// The tick from which a mission is paused. In real time the team gets the whole notice, even if the
// world's last message is old. In lockstep the world stands by first.
#include <gtest/gtest.h>

#include "tests/coordinator/driven_coordinator.h"

namespace ergocast {
namespace {

using namespace test;

/// A mission of `agents` in real time at twice the speed.
Mission realtime_mission(int agents) {
  Mission mission = small_mission(agents);
  mission.timing.pace = Pace::kRealtime;
  mission.timing.realtime_factor = 2;
  mission.timing.dt_s = 0.1;
  return mission;
}

/// The notice of 2 s, in ticks of realtime_mission().
constexpr Tick kNotice = 40;

/// The amendment after `changes` others: an even one pauses, an odd one resumes.
Amend pause_after(int changes) {
  return {.header = {kRun, kOperator, 1, next_sequence(), 0},
          .number = changes,
          .kind = changes % 2 == 0 ? AmendmentKind::kPause : AmendmentKind::kResume};
}

TEST(Pausing, CountsTheTicksSinceTheWorldsLastMessage) {
  for (const auto& [since, ticks] : {std::pair{0ms, 0}, {425ms, 8}, {825ms, 16}}) {
    Coordinator coordinator = running_coordinator(realtime_mission(2));
    give(coordinator, world_where(10, {9, 9}), at(1s));
    give(coordinator, pause_after(0), at(1s + since));
    ASSERT_EQ(coordinator.holds().size(), 1U) << since.count();
    EXPECT_EQ(coordinator.holds()[0].from, 10 + 1 + ticks + kNotice) << since.count();
    give(coordinator, pause_after(1), at(1s + since));
    EXPECT_EQ(coordinator.holds()[0].until, 10 + 1 + ticks + kNotice + 1) << since.count();
  }
}

TEST(Pausing, GoesByTheNewestTickOfAnyAgent) {
  Coordinator coordinator = running_coordinator(realtime_mission(2));
  give(coordinator, world_where(10, {9, 9}), at(1s));
  AgentStatus status = status_of(1, next_sequence(), 12);
  status.header.tick = 13;
  give(coordinator, status, at(1s));
  give(coordinator, pause_after(0), at(1s));
  ASSERT_EQ(coordinator.holds().size(), 1U);
  EXPECT_EQ(coordinator.holds()[0].from, 13 + 1 + kNotice);
}

TEST(Pausing, NeedsAWorldThatSends) {
  Coordinator coordinator = running_coordinator(realtime_mission(2));
  give(coordinator, pause_after(0), at(1s));
  EXPECT_TRUE(coordinator.holds().empty());
  give(coordinator, world_where(10, {9, 9}), at(1s));
  give(coordinator, pause_after(0), at(60s));
  EXPECT_TRUE(coordinator.holds().empty());
}

TEST(Pausing, ARecordingOfAPauseThatWasNotObeyedHasNoEffect) {
  Mission mission = realtime_mission(2);
  mission.timing.tick_count = 10000;
  Coordinator coordinator = running_coordinator(mission);
  give(coordinator, world_where(10, {9, 9}), at(500ms));
  advance(coordinator, at(500ms));
  Amend pause = pause_after(0);
  pause.header.tick = 10;
  give(coordinator, pause, at(10s));  // the world has been silent for so long
  ASSERT_TRUE(coordinator.holds().empty());
  for (int second = 11; second < 31; ++second) {
    give(coordinator, world_where(second * 20, {9, 9}), at(second * 1s));
    advance(coordinator, at(second * 1s));
  }
  give(coordinator, pause, at(31s));
  EXPECT_TRUE(coordinator.holds().empty()) << "another process chooses the tick";
  EXPECT_EQ(coordinator.late_commands(), 1);
  pause.header.tick = coordinator.tick();
  give(coordinator, pause, at(31s));
  EXPECT_EQ(coordinator.holds().size(), 1U);
}

TEST(Pausing, InLockstepBeginsWithTheTickAfterTheNextOnceTheWorldStands) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  WorldState world = world_where(10, {9, 9});
  for (const int changes : {0, 1}) {
    give(coordinator, world, at(1s));
    give(coordinator, pause_after(changes), at(1s));
    const auto parts = only<MissionPart>(advance(coordinator, at(1s)));
    ASSERT_FALSE(parts.empty());
    ASSERT_GE(parts[0].stand_by_revision, 0);
    ++world.header.tick;  // it does not know yet that it must stand by
    give(coordinator, world, at(1s));
    EXPECT_EQ(named_changes(coordinator.holds()), changes);
    world.roster_revision = parts[0].stand_by_revision;
    give(coordinator, world, at(1s));
    ASSERT_EQ(named_changes(coordinator.holds()), changes + 1);
  }
  EXPECT_EQ(coordinator.holds(), (std::vector<Hold>{{11 + 2, 12 + 2}}));
}

TEST(Pausing, InLockstepBeginsAlsoIfARestartedWorldStandsATickBehind) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  WorldState world = world_where(10, {9, 9});
  give(coordinator, world, at(1s));
  give(coordinator, pause_after(0), at(1s));
  const auto parts = only<MissionPart>(advance(coordinator, at(1s)));
  ASSERT_FALSE(parts.empty());
  ++world.header.tick;
  give(coordinator, world, at(1s));
  --world.header.tick;
  give(coordinator, world, at(1s));
  EXPECT_EQ(named_changes(coordinator.holds()), 0) << "a world repeats old states for its logger";
  world.roster_revision = parts[0].stand_by_revision;
  give(coordinator, world, at(1s));
  EXPECT_EQ(named_changes(coordinator.holds()), 1);
}

TEST(Pausing, AWishThatWaitsDoesNotOutlastAListThatIsAdopted) {
  const Participant me(Role::kCoordinator, {kRun, kCoordinator, kCoordinatorLife});
  const SignsOfLife signs{me, at(1s)};
  const TeamPlaces places;
  const std::vector<RosterEntry> roster;
  Amending amending;
  Announcement announcement;
  amending.obey(pause_after(0), small_mission(2), {}, {signs, places, roster}, announcement);
  ASSERT_GE(amending.stand_by_revision(), 0);
  amending.adopt(only_pauses({{5, -1}}));
  EXPECT_LT(amending.stand_by_revision(), 0) << "it would end the other pause";
}

TEST(Pausing, EndsTheLastOfTheMostHoldsButBeginsNoOther) {
  const Participant me(Role::kCoordinator, {kRun, kCoordinator, kCoordinatorLife});
  for (const bool open : {false, true}) {
    std::vector<Hold> holds;
    for (Tick from = 0; holds.size() < kMaxHolds; from += 2) holds.push_back({from, from + 1});
    if (open) holds.back().until = -1;
    Amending amending;
    amending.plan(only_pauses(holds));
    Announcement announcement;
    const int changes = named_changes(holds);
    const SignsOfLife signs{me, at(1s)};
    const TeamPlaces places;
    const std::vector<RosterEntry> roster;
    amending.obey(pause_after(changes), small_mission(2), {}, {signs, places, roster},
                  announcement);
    EXPECT_EQ(amending.stand_by_revision() >= 0, open);
    EXPECT_EQ(announcement.revision(), open ? 1 : 0);
  }
}

}  // namespace
}  // namespace ergocast
