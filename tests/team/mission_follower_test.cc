// SPDX-License-Identifier: BSD-3-Clause
// MISSION's parts assembled: any order, repeats, losses, mixed revisions and forgeries.
#include "team/mission_follower.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <set>

#include "tests/support/team.h"

namespace ergocast {
namespace {

using namespace test;

constexpr int kParts = 4;

/// Part `p` of revision `revision`: agent 10·revision + p, and that part of the plan.
MissionPart part_of(std::int64_t revision, int p, int parts = kParts,
                    MissionState state = MissionState::kWaiting) {
  announce(small_mission(1));
  MissionPart part = mission_part(revision, state, {});
  const auto mark = static_cast<AgentId>(10 * revision + p);
  part.part = p;
  part.parts = parts;
  part.roster = {{author_of(mark), 0, -1}};
  const auto place = [&](int i) {
    const auto share = static_cast<std::ptrdiff_t>(announced_plan.size()) / std::max(parts, 1);
    return announced_plan.begin() +
           (i == parts ? announced_plan.end() - announced_plan.begin() : share * i);
  };
  if (0 <= p && p < parts) part.plan.assign(place(p), place(p + 1));
  return part;
}

std::vector<AgentId> agents_of(const MissionFollower& follower) {
  std::vector<AgentId> agents;
  for (const RosterEntry& entry : follower.roster()) agents.push_back(entry.author.agent);
  return agents;
}

TEST(MissionFollower, PutsThePartsTogetherInAnyOrder) {
  std::vector<int> order{0, 1, 2, 3};
  do {
    MissionFollower follower;
    for (int i = 0; i < kParts; ++i) {
      const bool complete = follower.receive(part_of(1, order[static_cast<std::size_t>(i)]));
      EXPECT_EQ(complete, i == kParts - 1) << "true once, for the part that completes it";
      EXPECT_EQ(follower.mission().has_value(), i == kParts - 1);
    }
    EXPECT_EQ(agents_of(follower), (std::vector<AgentId>{10, 11, 12, 13}));
    EXPECT_EQ(follower.plan(), encode_plan(small_mission(1)));
    EXPECT_EQ(follower.revision(), 1);
  } while (std::next_permutation(order.begin(), order.end()));
}

TEST(MissionFollower, RepeatedPartsCountOnce) {
  MissionFollower follower;
  for (const int p : {0, 0, 1, 0, 1, 2, 2}) EXPECT_FALSE(follower.receive(part_of(1, p)));
  EXPECT_TRUE(follower.receive(part_of(1, 3)));
  for (int p = 0; p < kParts; ++p) EXPECT_FALSE(follower.receive(part_of(1, p)));
  EXPECT_EQ(agents_of(follower).size(), 4u);
}

TEST(MissionFollower, ALostPartIsMadeUpForByTheNextRepeat) {
  MissionFollower follower;
  for (const int p : {0, 1, 3}) EXPECT_FALSE(follower.receive(part_of(1, p)));
  EXPECT_EQ(follower.revision(), -1);
  EXPECT_FALSE(follower.receive(part_of(1, 0)));
  EXPECT_FALSE(follower.receive(part_of(1, 1)));
  EXPECT_TRUE(follower.receive(part_of(1, 2)));
}

TEST(MissionFollower, NeverMixesTwoRevisions) {
  MissionFollower follower;
  follower.receive(part_of(1, 0));
  follower.receive(part_of(1, 1));
  follower.receive(part_of(2, 2));
  follower.receive(part_of(2, 3));
  follower.receive(part_of(1, 2));
  EXPECT_TRUE(follower.receive(part_of(1, 3)));
  EXPECT_EQ(agents_of(follower), (std::vector<AgentId>{10, 11, 12, 13}));
  follower.receive(part_of(2, 0));
  EXPECT_TRUE(follower.receive(part_of(2, 1)));
  EXPECT_EQ(agents_of(follower), (std::vector<AgentId>{20, 21, 22, 23}));
}

TEST(MissionFollower, NeverMixesTwoCoordinatorsRevisionsWithOneNumber) {
  const auto of_coordinator = [](std::int64_t which, int p) {
    MissionPart part = part_of(which, p);
    part.revision = 7;
    part.content_hash = static_cast<std::uint64_t>(which);
    return part;
  };
  MissionFollower follower;
  for (const int p : {0, 1, 2}) EXPECT_FALSE(follower.receive(of_coordinator(1, p)));
  for (const int p : {3, 0, 1}) EXPECT_FALSE(follower.receive(of_coordinator(2, p)));
  EXPECT_TRUE(follower.receive(of_coordinator(2, 2)));
  EXPECT_EQ(agents_of(follower), (std::vector<AgentId>{20, 21, 22, 23}));
}

TEST(MissionFollower, APartOfARevisionThatNeverCompletesBlocksNoOlderOne) {
  MissionFollower follower;
  for (int revision = 10; revision < 100; ++revision) follower.receive(part_of(revision, 0));
  follower.receive(part_of(100, 0));
  for (int p = 0; p < kParts - 1; ++p) EXPECT_FALSE(follower.receive(part_of(98, p)));
  EXPECT_TRUE(follower.receive(part_of(98, kParts - 1)));
}

TEST(MissionFollower, KeepsTheNewestFourUnfinishedRevisionsAndOfOlderOnesTheNewestParts) {
  MissionFollower follower;
  for (int revision = 1; revision <= 6; ++revision) follower.receive(part_of(revision, 0));
  for (int p = 1; p < kParts; ++p) EXPECT_FALSE(follower.receive(part_of(1, p))) << "forgotten";
  for (int p = 1; p < kParts - 1; ++p) EXPECT_FALSE(follower.receive(part_of(3, p)));
  EXPECT_TRUE(follower.receive(part_of(3, kParts - 1)));
}

TEST(MissionFollower, KeepsWhatItHasUntilANewerRevisionIsComplete) {
  MissionFollower follower;
  for (int p = 0; p < kParts; ++p) follower.receive(part_of(1, p));
  for (int p = 0; p < kParts - 1; ++p) {
    follower.receive(part_of(2, p, kParts, MissionState::kRunning));
    EXPECT_EQ(follower.state(), MissionState::kWaiting);
    EXPECT_EQ(agents_of(follower), (std::vector<AgentId>{10, 11, 12, 13}));
  }
  EXPECT_TRUE(follower.receive(part_of(2, 3, kParts, MissionState::kRunning)));
  EXPECT_EQ(follower.state(), MissionState::kRunning);
  EXPECT_FALSE(follower.over());
}

TEST(MissionFollower, AnOlderRevisionNeverComesBack) {
  MissionFollower follower;
  follower.receive(mission_part(5, MissionState::kEnded, roster_of(2), "enough"));
  EXPECT_FALSE(follower.receive(mission_part(4, MissionState::kRunning, roster_of(1))));
  EXPECT_FALSE(follower.receive(mission_part(5, MissionState::kRunning, roster_of(1))));
  EXPECT_TRUE(follower.over());
  EXPECT_EQ(follower.reason(), "enough");
  EXPECT_EQ(follower.roster().size(), 2u);
}

TEST(MissionFollower, PartsThatDisagreeAboutTheirNumberStartAfresh) {
  MissionFollower follower;
  follower.receive(part_of(1, 0, 2));
  EXPECT_FALSE(follower.receive(part_of(1, 1, 3))) << "two of two, but not of one message";
  EXPECT_FALSE(follower.receive(part_of(1, 0, 2)));
  EXPECT_TRUE(follower.receive(part_of(1, 1, 2)));
}

TEST(MissionFollower, HostileCountsHaveNoEffect) {
  constexpr std::int32_t kMost = std::numeric_limits<std::int32_t>::max();
  constexpr std::int32_t kLeast = std::numeric_limits<std::int32_t>::min();
  MissionFollower follower;
  follower.receive(part_of(1, 0, 2));
  const std::pair<int, int> lies[] = {
      {0, 0},      {0, -1},        {-1, 2},    {2, 2},      {5, 2},
      {0, kLeast}, {kMost, kMost}, {0, kMost}, {kLeast, 2}, {0, kMaxMissionParts + 1}};
  for (const auto& [part, parts] : lies) {
    EXPECT_FALSE(follower.receive(part_of(1, part, parts))) << part << " of " << parts;
    EXPECT_FALSE(follower.receive(part_of(2, part, parts))) << part << " of " << parts;
  }
  EXPECT_TRUE(follower.receive(part_of(1, 1, 2))) << "what was collected is still there";
}

TEST(MissionFollower, OnlyTheCoordinatorIsBelieved) {
  MissionFollower follower;
  MissionPart forged = part_of(1, 0, 1);
  for (const AgentId sender : {0, 5, kUnassigned, kWorld, kLogger, kOperator}) {
    forged.header.sender = sender;
    EXPECT_FALSE(follower.receive(forged));
  }
  EXPECT_FALSE(follower.mission().has_value());
}

TEST(MissionFollower, DecodesThePlanOnce) {
  MissionFollower follower;
  follower.receive(part_of(0, 0, 1));
  ASSERT_TRUE(follower.mission());
  const double* decoded = follower.mission()->target_coefficients.data();
  for (std::int64_t revision = 1; revision < 5; ++revision)
    follower.receive(part_of(revision, 0, 1));
  EXPECT_EQ(follower.mission()->target_coefficients.data(), decoded) << "the very same";
  EXPECT_EQ(follower.revision(), 4);
}

TEST(MissionFollower, ReportsThatAPlanIsUnreadable) {
  MissionFollower follower;
  EXPECT_FALSE(follower.plan_problem());
  for (std::int64_t revision = 0; revision < 3; ++revision) {
    MissionPart part = part_of(revision, 0, 1);
    part.plan = kNoPlan;
    EXPECT_TRUE(follower.receive(part));
    EXPECT_EQ(follower.plan_problem(), why_no_plan());
    EXPECT_FALSE(follower.mission().has_value());
  }
}

TEST(MissionFollower, TakesNoPlanButTheOneThatItExpects) {
  for (const bool expected : {true, false}) {
    MissionFollower follower;
    follower.expect_plan(encode_plan(small_mission(expected ? 1 : 2)));
    EXPECT_TRUE(follower.receive(part_of(1, 0, 1)));
    EXPECT_EQ(follower.mission().has_value(), expected);
    EXPECT_EQ(follower.plan_problem().has_value(), !expected);
    EXPECT_EQ(follower.plan(), encode_plan(small_mission(1))) << "what was received";
  }
}

TEST(MissionFollower, ARevisionWithAnotherPlanChangesNothing) {
  MissionFollower follower;
  for (int p = 0; p < kParts; ++p) follower.receive(part_of(1, p));
  for (int p = 0; p < kParts; ++p) {
    MissionPart other = part_of(2, p, kParts, MissionState::kFailed);
    if (p == 2) other.plan.push_back(std::byte{9});
    EXPECT_FALSE(follower.receive(other));
  }
  EXPECT_EQ(follower.foreign_plans(), 1);
  EXPECT_EQ(follower.revision(), 1);
  EXPECT_EQ(follower.state(), MissionState::kWaiting);
  EXPECT_EQ(agents_of(follower), (std::vector<AgentId>{10, 11, 12, 13}));
  EXPECT_EQ(follower.plan(), encode_plan(small_mission(1)));
  for (int p = 0; p < kParts; ++p) follower.receive(part_of(2, p));
  EXPECT_EQ(follower.revision(), 2) << "the same number with our plan is accepted";
  EXPECT_EQ(follower.foreign_plans(), 1);
}

/// The parts of a complete revision 1, and of `revision`, which changes the parts `changed`.
struct Change {
  explicit Change(std::set<int> changed, std::int64_t revision = 2) {
    for (int p = 0; p < kParts; ++p) {
      before.push_back(part_of(1, p));
      after.push_back(part_of(revision, p));
      if (!changed.contains(p)) after.back().roster = before.back().roster;
    }
    for (auto* parts : {&before, &after}) {
      std::uint64_t sum = 0;
      for (const MissionPart& part : *parts) sum += hash_of(part);
      for (MissionPart& part : *parts) part.content_hash = sum;
    }
  }
  std::vector<MissionPart> before, after;
};

TEST(MissionFollower, PartsThatHaveNotChangedNeedNotComeAgain) {
  const Change change({1, 3});
  MissionFollower follower;
  for (const MissionPart& part : change.before) follower.receive(part);
  EXPECT_FALSE(follower.receive(change.after[1]));
  EXPECT_FALSE(follower.receive(change.after[2])) << "one that has changed is missing";
  EXPECT_EQ(follower.revision(), 1);
  EXPECT_TRUE(follower.receive(change.after[3]));
  EXPECT_EQ(follower.revision(), 2);
  EXPECT_EQ(agents_of(follower), (std::vector<AgentId>{10, 12, 21, 23}));
}

TEST(MissionFollower, WhatItRepeatsOfSeveralRevisionsMakesTheMissionWholeForOthers) {
  const Change change({1, 3});
  MissionFollower follower, other;
  for (const MissionPart& part : change.before) follower.receive(part);
  for (const int p : {1, 3}) follower.receive(change.after[static_cast<std::size_t>(p)]);
  ASSERT_EQ(follower.parts().size(), static_cast<std::size_t>(kParts));
  std::vector<MissionPart> parts = follower.parts();
  std::reverse(parts.begin(), parts.end());  // the last is of the older revision
  for (const MissionPart& part : parts) other.receive(part);
  EXPECT_EQ(other.revision(), 2);
  EXPECT_EQ(agents_of(other), agents_of(follower));
}

TEST(MissionFollower, APartOfARevisionInBetweenIsNoPartOfOneThatChangedItAgain) {
  const Change first({1}, 2), second({1}, 3);
  MissionFollower follower;
  for (const MissionPart& part : first.before) follower.receive(part);
  MissionPart unchanged = second.after[0];
  EXPECT_FALSE(follower.receive(unchanged));
  EXPECT_TRUE(follower.receive(first.after[1])) << "revision 2 is complete";
  EXPECT_FALSE(follower.receive(unchanged)) << "revision 3 changed it again";
  EXPECT_EQ(follower.revision(), 2);
  EXPECT_TRUE(follower.receive(second.after[1]));
  EXPECT_EQ(agents_of(follower), (std::vector<AgentId>{10, 12, 13, 31}));
}

TEST(MissionFollower, FindsAnEntryByItsIncarnation) {
  MissionFollower follower;
  std::vector<RosterEntry> roster = roster_of(2);
  roster.push_back({{0, 99}, 4, 9});
  follower.receive(mission_part(0, MissionState::kRunning, roster));
  ASSERT_NE(follower.entry_of(99), nullptr);
  EXPECT_EQ(follower.entry_of(99)->active_from, 4);
  EXPECT_EQ(follower.entry_of(incarnation_of(1))->author.agent, 1);
  EXPECT_EQ(follower.entry_of(98), nullptr);
}

TEST(RosterEntry, IsActiveFromItsFirstTickUntilBeforeItsLast) {
  const RosterEntry entry{author_of(0), 4, 9}, member{author_of(0), 4, -1};
  EXPECT_FALSE(entry.active_at(3));
  EXPECT_TRUE(entry.active_at(4));
  EXPECT_TRUE(entry.active_at(8));
  EXPECT_FALSE(entry.active_at(9));
  EXPECT_TRUE(member.active_at(1000000));
}

TEST(Sequencer, CountsEachBusByItself) {
  Sequencer sequencer;
  EXPECT_EQ(sequencer.next(Bus::kSwarm), 1);
  EXPECT_EQ(sequencer.next(Bus::kSwarm), 2);
  EXPECT_EQ(sequencer.next(Bus::kCommand), 1);
  EXPECT_EQ(sequencer.next(Bus::kSwarm), 3);
  EXPECT_EQ(sequencer.total(), 4);
}

}  // namespace
}  // namespace ergocast
