// Agents that leave, and coverage that is forgotten: what the roster says of those who are gone.
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/coordinator/driven_coordinator.h"

namespace ergocast {
namespace {

using namespace test;

RosterEntry entry_of(const Coordinator& coordinator, const Author& author) {
  const auto at = std::find_if(coordinator.roster().begin(), coordinator.roster().end(),
                               [&](const RosterEntry& entry) { return entry.author == author; });
  EXPECT_NE(at, coordinator.roster().end());
  return at == coordinator.roster().end() ? RosterEntry{} : *at;
}

/// The revision it says at `now`, or nothing.
std::optional<std::int64_t> said_revision(Coordinator& coordinator, Instant now) {
  const auto parts = only<MissionPart>(advance(coordinator, now));
  return parts.empty() ? std::nullopt : std::optional(parts[0].revision);
}

// ---- leaving -------------------------------------------------------------------------------------

AgentStatus farewell_of(AgentId id, Tick tick) {
  AgentStatus status = status_of(id, 1000);
  status.phase = AgentPhase::kFinished;
  status.header.tick = tick;
  return status;
}

TEST(Leaving, AnAgentThatSaysItHasFinishedIsAMemberNoLonger) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  coordinator.receive(world_where(7, {6, 6}), at(100ms));
  coordinator.receive(farewell_of(1, 5), at(100ms));
  EXPECT_EQ(entry_of(coordinator, author_of(1)).active_until, 7);
  EXPECT_EQ(entry_of(coordinator, author_of(0)).active_until, -1);
  EXPECT_TRUE(said_revision(coordinator, at(100ms))) << "and all are told at once";
}

TEST(Leaving, ItsLastTickCountsEvenIfTheWorldHasNotSpokenOfItYet) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  coordinator.receive(world_where(7, {6, 6}), at(100ms));
  coordinator.receive(farewell_of(1, 9), at(100ms));
  EXPECT_EQ(entry_of(coordinator, author_of(1)).active_until, 9);
}

TEST(Leaving, ItsSuccessorNeedNotWaitForItsSilence) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  coordinator.receive(farewell_of(1, 5), at(100ms));
  coordinator.receive(hello_of(1, 99), at(101ms));
  EXPECT_EQ(entry_of(coordinator, {1, 99}).active_until, -1);
}

TEST(Leaving, TheEndOfTheMissionIsNone) {
  const Mission mission = small_mission(2);
  Coordinator coordinator = running_coordinator(mission);
  coordinator.receive(farewell_of(1, mission.timing.tick_count), at(100ms));
  EXPECT_EQ(entry_of(coordinator, author_of(1)).active_until, -1);
}

TEST(Leaving, AFormerLifesFarewellDoesNotConcernItsSuccessor) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  coordinator.receive(hello_of(1, 99), at(3s));
  coordinator.receive(farewell_of(1, 5), at(3s));
  EXPECT_EQ(entry_of(coordinator, {1, 99}).active_until, -1);
}

// ---- forgetting ----------------------------------------------------------------------------------

Mission forgetful(Pace pace = Pace::kRealtime) {
  Mission mission = small_mission(2);
  mission.forget_silent_after_s = 20;
  mission.timing.pace = pace;
  mission.timing.lockstep_timeout_s = 1000;
  return mission;
}

/// Agent 0 is heard at `now`; agent 1 is not.
void only_0_speaks(Coordinator& coordinator, Instant now) {
  coordinator.receive(status_of(0, now.time_since_epoch().count() + 1), now);
}

TEST(Forgetting, ASilentAgentsCoverageStopsCountingAfterItsTimeFromANamedTickOn) {
  Coordinator coordinator = running_coordinator(forgetful());
  coordinator.receive(world_where(50, {49, 49}), at(1s));
  only_0_speaks(coordinator, at(19s));
  const auto before = said_revision(coordinator, at(19999ms));
  EXPECT_EQ(entry_of(coordinator, author_of(1)).forgotten_from, -1);
  const auto after = said_revision(coordinator, at(20s));
  ASSERT_TRUE(before);
  ASSERT_TRUE(after);
  EXPECT_GT(*after, *before);
  const RosterEntry gone = entry_of(coordinator, author_of(1));
  // In real time the team gets two seconds of notice; 20 ticks and the one that has begun.
  EXPECT_EQ(gone.forgotten_from, 50 + 21);
  EXPECT_FALSE(gone.forgotten_at(70));
  EXPECT_TRUE(gone.forgotten_at(71));
  EXPECT_EQ(entry_of(coordinator, author_of(0)).forgotten_from, -1);
}

TEST(Forgetting, InLockstepActsAtTheTickThatWaits) {
  Coordinator coordinator = running_coordinator(forgetful(Pace::kLockstep));
  coordinator.receive(world_where(15, {15, 14}), at(1s));
  only_0_speaks(coordinator, at(19s));
  advance(coordinator, at(20s));
  EXPECT_EQ(entry_of(coordinator, author_of(1)).forgotten_from, 15);
}

TEST(Forgetting, IsDecidedOnce) {
  Coordinator coordinator = running_coordinator(forgetful());
  only_0_speaks(coordinator, at(19s));
  advance(coordinator, at(20s));
  const Tick from = entry_of(coordinator, author_of(1)).forgotten_from;
  coordinator.receive(world_where(90, {89, 0}), at(21s));
  only_0_speaks(coordinator, at(21s));
  advance(coordinator, at(40s));
  EXPECT_EQ(entry_of(coordinator, author_of(1)).forgotten_from, from);
}

TEST(Forgetting, SparesAFormerLifeWhileItsSuccessorLives) {
  // The successor has its predecessor's place and goes on with its work.
  Coordinator coordinator = running_coordinator(forgetful());
  coordinator.receive(hello_of(1, 99), at(3s));
  AgentStatus successors = status_of(1, 1);
  successors.header.incarnation = 99;
  coordinator.receive(successors, at(39s));
  only_0_speaks(coordinator, at(39s));
  advance(coordinator, at(40s));
  EXPECT_EQ(entry_of(coordinator, author_of(1)).forgotten_from, -1);
  only_0_speaks(coordinator, at(58s));
  advance(coordinator, at(59s));
  EXPECT_GE(entry_of(coordinator, author_of(1)).forgotten_from, 0) << "now both are gone";
  EXPECT_GE(entry_of(coordinator, {1, 99}).forgotten_from, 0);
}

TEST(Forgetting, IsNotDoneUnlessThePlanSaysSo) {
  Mission mission = forgetful();
  mission.forget_silent_after_s = 0;
  Coordinator coordinator = running_coordinator(mission);
  advance(coordinator, at(1h));
  EXPECT_EQ(entry_of(coordinator, author_of(1)).forgotten_from, -1);
}

}  // namespace
}  // namespace ergocast
