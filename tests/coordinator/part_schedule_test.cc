// SPDX-License-Identifier: BSD-3-Clause
// MISSION of large teams: changed parts are sent first, and all parts in turn.
#include "coordinator/part_schedule.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "tests/coordinator/driven_coordinator.h"

namespace ergocast {
namespace {

using namespace test;

std::vector<std::uint64_t> hashes_of(std::size_t parts) {
  std::vector<std::uint64_t> hashes(parts);
  std::iota(hashes.begin(), hashes.end(), std::uint64_t{1});
  return hashes;
}

TEST(PartSchedule, ASmallMissionIsSentAsAWhole) {
  for (const std::size_t parts : {std::size_t{1}, PartSchedule::kMostAtOnce}) {
    PartSchedule schedule;
    for (int turn = 0; turn < 5; ++turn) EXPECT_EQ(schedule.next(hashes_of(parts)).size(), parts);
  }
}

TEST(PartSchedule, AllPartsOfALargeOneComeInTurn) {
  constexpr std::size_t kParts = 512, kTurns = kParts / PartSchedule::kMostAtOnce;
  PartSchedule schedule;
  std::set<std::size_t> sent;
  for (std::size_t turn = 0; turn < kTurns; ++turn) {
    const auto now = schedule.next(hashes_of(kParts));
    EXPECT_LE(now.size(), PartSchedule::kMostAtOnce);
    sent.insert(now.begin(), now.end());
    EXPECT_EQ(schedule.behind(), turn + 1 < kTurns);
  }
  EXPECT_EQ(sent.size(), kParts);
}

TEST(PartSchedule, WhatHasChangedIsSentThreeTimesAndTheOthersMeanwhile) {
  auto hashes = hashes_of(200);
  PartSchedule schedule;
  for (int turn = 0; turn < 50; ++turn) schedule.next(hashes);
  hashes[150] = 4711;
  std::set<std::size_t> others;
  for (int turn = 0; turn < 7; ++turn) {
    const auto now = schedule.next(hashes);
    const bool sent = std::find(now.begin(), now.end(), 150U) != now.end();
    EXPECT_TRUE(sent || turn >= PartSchedule::kTimesSent) << turn;
    EXPECT_FALSE(schedule.behind());
    others.insert(now.begin(), now.end());
  }
  EXPECT_EQ(others.size(), 200u);
}

/// A mission for the largest team.
Mission large_mission() {
  Mission mission = small_mission(1);
  mission.starts_m.assign(kMaxAgents, {100, 500, 0});
  return mission;
}

TEST(LargeTeam, IsAdmittedAndFollowedFromWhatChanges) {
  Coordinator coordinator = coordinator_of(large_mission());
  MissionFollower follower;
  const auto follow = [&](Instant now) {
    std::set<std::int32_t> parts;
    for (const MissionPart& part : only<MissionPart>(advance(coordinator, now))) {
      follower.receive(part);
      parts.insert(part.part);
    }
    EXPECT_LE(parts.size(), PartSchedule::kMostAtOnce);
    return parts.size();
  };
  admit_all(coordinator, kMaxAgents, at(0s));
  ASSERT_EQ(coordinator.roster().size(), static_cast<std::size_t>(kMaxAgents));
  for (int i = 0; i < 6; ++i) follow(at(i * 100ms));
  EXPECT_EQ(follower.roster().size(), static_cast<std::size_t>(kMaxAgents));
  ASSERT_TRUE(follower.mission());
  EXPECT_EQ(follower.mission()->starts_m.size(), static_cast<std::size_t>(kMaxAgents));

  AgentStatus farewell = status_of(700, next_sequence());
  farewell.phase = AgentPhase::kFinished;
  give(coordinator, farewell, at(900ms));
  follow(at(900ms));
  EXPECT_GE(follower.entry_of(incarnation_of(700))->active_until, 0) << "one part has changed";
}

TEST(LargeTeam, WithAllItsIncarnationsIsFollowedAlsoByALatecomerUnderLoss) {
  Mission mission = large_mission();
  mission.timing.pace = Pace::kRealtime;
  mission.timing.admission_timeout_s = 3600;
  Coordinator coordinator = coordinator_of(mission);
  Instant now = at(0s);
  for (Incarnation incarnation = 0; incarnation < 4; ++incarnation) {
    for (AgentId id = 0; id < kMaxAgents; ++id) {
      const Incarnation nonce = 10000 * (incarnation + 1) + static_cast<Incarnation>(id);
      give(coordinator, hello_of(id, nonce), now);
    }
    now += 10s;
    advance(coordinator, now);
    now += 1s;
  }
  ASSERT_EQ(coordinator.roster().size(), kMaxRosterEntries);
  MissionFollower follower;
  int sent = 0, repetitions = 0;
  // Every fifth datagram is lost: after r rounds of 22 repetitions a part is missing with
  // probability 0.2^r.
  for (; repetitions < 8 * 22 && follower.roster().size() < kMaxRosterEntries; ++repetitions) {
    for (const MissionPart& part : only<MissionPart>(advance(coordinator, now))) {
      if (++sent % 5 != 0) follower.receive(part);
    }
    now += 1s;
  }
  EXPECT_EQ(follower.roster().size(), kMaxRosterEntries) << repetitions;
  EXPECT_GE(repetitions, 16);
}

}  // namespace
}  // namespace ergocast
