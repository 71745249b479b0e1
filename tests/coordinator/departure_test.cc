// SPDX-License-Identifier: BSD-3-Clause
// Agents that leave, and coverage that is forgotten: the roster entries of former members.
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

/// The revision that it sends at `now`, or nothing.
std::optional<std::int64_t> sent_revision(Coordinator& coordinator, Instant now) {
  const auto parts = only<MissionPart>(advance(coordinator, now));
  return parts.empty() ? std::nullopt : std::optional(parts[0].revision);
}

// ---- leaving ----

AgentStatus farewell_of(AgentId id, Tick tick) {
  AgentStatus status = status_of(id, 1000);
  status.phase = AgentPhase::kFinished;
  status.header.tick = tick;
  return status;
}

TEST(Leaving, AnAgentThatReportsItsEndIsAMemberNoLonger) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  give(coordinator, world_where(7, {6, 6}), at(100ms));
  give(coordinator, farewell_of(1, 5), at(100ms));
  EXPECT_EQ(entry_of(coordinator, author_of(1)).active_until, 7);
  EXPECT_EQ(entry_of(coordinator, author_of(0)).active_until, -1);
  EXPECT_TRUE(sent_revision(coordinator, at(100ms))) << "and all receive it at once";
}

TEST(Leaving, ItsLastTickCountsEvenIfTheWorldHasNotSentItYet) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  give(coordinator, world_where(7, {6, 6}), at(100ms));
  give(coordinator, farewell_of(1, 9), at(100ms));
  EXPECT_EQ(entry_of(coordinator, author_of(1)).active_until, 9);
}

TEST(Leaving, ItsSuccessorNeedNotWaitForItsSilence) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  give(coordinator, farewell_of(1, 5), at(100ms));
  give(coordinator, hello_of(1, 99), at(101ms));
  EXPECT_EQ(entry_of(coordinator, {1, 99}).active_until, -1);
}

TEST(Leaving, TheEndOfTheMissionIsNone) {
  const Mission mission = small_mission(2);
  Coordinator coordinator = running_coordinator(mission);
  give(coordinator, farewell_of(1, mission.timing.tick_count), at(100ms));
  EXPECT_EQ(entry_of(coordinator, author_of(1)).active_until, -1);
}

TEST(Leaving, AFormerIncarnationsFarewellDoesNotConcernItsSuccessor) {
  Coordinator coordinator = running_coordinator(small_mission(2));
  give(coordinator, hello_of(1, 99), at(3s));
  give(coordinator, farewell_of(1, 5), at(3s));
  EXPECT_EQ(entry_of(coordinator, {1, 99}).active_until, -1);
}

// ---- forgetting ----

Mission forgetful(Pace pace = Pace::kRealtime) {
  Mission mission = small_mission(2);
  mission.forget_silent_after_s = 20;
  mission.timing.pace = pace;
  mission.timing.lockstep_timeout_s = 1000;
  return mission;
}

/// Only one agent sends a status at `now`.
void reports(Coordinator& coordinator, const Author& author, Instant now) {
  AgentStatus status = status_of(author.agent, now.time_since_epoch().count() + 1);
  status.header.incarnation = author.incarnation;
  give(coordinator, status, now);
}
void only_0_speaks(Coordinator& coordinator, Instant now) {
  reports(coordinator, author_of(0), now);
}

/// The world at `tick`, which uses roster `revision`.
WorldState flown_by(std::int64_t revision, Tick tick) {
  WorldState world = world_where(tick, {tick - 1, tick - 1});
  world.roster_revision = revision;
  return world;
}

/// A coordinator whose agent 1 has been silent for 20 s at tick 50; the newest revision was sent.
Coordinator with_1_forgotten(Pace pace = Pace::kRealtime) {
  Coordinator coordinator = running_coordinator(forgetful(pace));
  give(coordinator, flown_by(1, 50), at(1s));
  only_0_speaks(coordinator, at(19s));
  advance(coordinator, at(20s));
  EXPECT_TRUE(entry_of(coordinator, author_of(1)).forgotten);
  return coordinator;
}

TEST(Forgetting, ASilentAgentsCoverageStopsCountingAfterItsTimeFromANamedTickOn) {
  Coordinator coordinator = running_coordinator(forgetful());
  give(coordinator, world_where(50, {49, 49}), at(1s));
  only_0_speaks(coordinator, at(19s));
  const auto before = sent_revision(coordinator, at(19999ms));
  EXPECT_FALSE(entry_of(coordinator, author_of(1)).forgotten);
  const auto after = sent_revision(coordinator, at(20s));
  ASSERT_TRUE(before);
  ASSERT_TRUE(after);
  EXPECT_GT(*after, *before);
  const RosterEntry gone = entry_of(coordinator, author_of(1));
  // In real time the team gets two seconds of notice: 20 ticks, and the one that has begun.
  EXPECT_EQ(gone.since_tick, 50 + 21);
  EXPECT_FALSE(gone.forgotten_at(70, *after));
  EXPECT_TRUE(gone.forgotten_at(71, *after));
  EXPECT_FALSE(gone.forgotten_at(71, *before)) << "the world does not know it yet";
  EXPECT_FALSE(entry_of(coordinator, author_of(0)).forgotten);
}

TEST(Forgetting, InLockstepActsAtTheNextTick) {
  EXPECT_EQ(entry_of(with_1_forgotten(Pace::kLockstep), author_of(1)).since_tick, 51);
}

TEST(Forgetting, IsDecidedOnce) {
  Coordinator coordinator = with_1_forgotten();
  const Tick from = entry_of(coordinator, author_of(1)).since_tick;
  give(coordinator, flown_by(1000, 90), at(21s));
  only_0_speaks(coordinator, at(39s));
  advance(coordinator, at(40s));
  EXPECT_EQ(entry_of(coordinator, author_of(1)).since_tick, from);
}

TEST(Forgetting, IsRevokedFromANamedTickOnWhenTheAgentSendsAgain) {
  for (const Pace pace : {Pace::kRealtime, Pace::kLockstep}) {
    Coordinator coordinator = with_1_forgotten(pace);
    const RosterEntry gone = entry_of(coordinator, author_of(1));
    give(coordinator, flown_by(gone.since_revision, 90), at(21s));
    reports(coordinator, author_of(1), at(21s));
    const auto sent = sent_revision(coordinator, at(21s));
    ASSERT_TRUE(sent) << "at once";
    const RosterEntry back = entry_of(coordinator, author_of(1));
    EXPECT_FALSE(back.forgotten);
    EXPECT_EQ(back.since_tick, pace == Pace::kLockstep ? 91 : 90 + 21);
    EXPECT_EQ(back.since_revision, *sent);
    EXPECT_TRUE(back.forgotten_at(back.since_tick - 1, *sent));
    EXPECT_TRUE(back.forgotten_at(back.since_tick, *sent - 1));
    EXPECT_FALSE(back.forgotten_at(back.since_tick, *sent));
  }
}

TEST(Forgetting, IsNotRevokedBeforeItHasHappenedForAll) {
  Coordinator coordinator = with_1_forgotten();
  const RosterEntry gone = entry_of(coordinator, author_of(1));
  reports(coordinator, author_of(1), at(20500ms));
  advance(coordinator, at(20500ms));
  EXPECT_TRUE(entry_of(coordinator, author_of(1)).forgotten) << "some agents would never do it";
  give(coordinator, flown_by(gone.since_revision, gone.since_tick), at(22s));
  advance(coordinator, at(22s));
  EXPECT_FALSE(entry_of(coordinator, author_of(1)).forgotten);
}

TEST(Forgetting, IsNotRevokedByATakeover) {
  Mission mission = forgetful();
  announce(mission);
  Coordinator coordinator({0, 0xc1, "here", kVersion}, announced_plan, Takeover::kMust);
  MissionPart memory = mission_part(7, MissionState::kRunning,
                                    {{author_of(0), 0, -1}, {author_of(1), 0, -1, true, 5, 3}});
  advance(coordinator, at(0s));
  give(coordinator, status_of(0, 1), at(0s));
  give(coordinator, memory, at(0s));
  advance(coordinator, at(1s));
  give(coordinator, flown_by(2000, 9), at(1s));
  only_0_speaks(coordinator, at(2s));
  advance(coordinator, at(2s));
  EXPECT_TRUE(entry_of(coordinator, author_of(1)).forgotten) << "nothing was received of it";
  reports(coordinator, author_of(1), at(3s));
  advance(coordinator, at(3s));
  EXPECT_FALSE(entry_of(coordinator, author_of(1)).forgotten);
}

TEST(Forgetting, NoAgentByACoordinatorThatReceivesNothing) {
  Coordinator coordinator = running_coordinator(forgetful());
  for (int s = 1; s < 60; ++s) advance(coordinator, at(s * 1s));
  for (const AgentId id : {0, 1})
    EXPECT_FALSE(entry_of(coordinator, author_of(id)).forgotten) << id;
  only_0_speaks(coordinator, at(60s));
  advance(coordinator, at(60s));
  EXPECT_FALSE(entry_of(coordinator, author_of(1)).forgotten) << "its cable was pulled, not theirs";
  for (int s = 61; s <= 80; ++s) {
    only_0_speaks(coordinator, at(s * 1s));
    advance(coordinator, at(s * 1s));
  }
  EXPECT_TRUE(entry_of(coordinator, author_of(1)).forgotten);
}

TEST(Forgetting, SparesAFormerIncarnationWhileItsSuccessorRuns) {
  // The successor takes the former agent's place and continues its work.
  Coordinator coordinator = running_coordinator(forgetful());
  advance(coordinator, at(3s));
  give(coordinator, hello_of(1, 99), at(3s));
  reports(coordinator, {1, 99}, at(39s));
  only_0_speaks(coordinator, at(39s));
  advance(coordinator, at(40s));
  EXPECT_FALSE(entry_of(coordinator, author_of(1)).forgotten);
  only_0_speaks(coordinator, at(58s));
  advance(coordinator, at(59s));
  EXPECT_TRUE(entry_of(coordinator, author_of(1)).forgotten) << "now both are gone";
  EXPECT_TRUE(entry_of(coordinator, {1, 99}).forgotten);
  give(coordinator, flown_by(1000, 90), at(60s));
  reports(coordinator, {1, 99}, at(60s));
  advance(coordinator, at(60s));
  EXPECT_FALSE(entry_of(coordinator, author_of(1)).forgotten) << "and both are back";
  EXPECT_FALSE(entry_of(coordinator, {1, 99}).forgotten);
}

TEST(Forgetting, IsNotDoneUnlessThePlanRequiresIt) {
  Mission mission = forgetful();
  mission.forget_silent_after_s = 0;
  Coordinator coordinator = running_coordinator(mission);
  only_0_speaks(coordinator, at(3599s));
  advance(coordinator, at(1h));
  EXPECT_FALSE(entry_of(coordinator, author_of(1)).forgotten);
}

}  // namespace
}  // namespace ergocast
