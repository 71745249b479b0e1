// SPDX-License-Identifier: BSD-3-Clause
// The rules of repair: the content of a digest, which gap gets an answer, which agent answers and
// when. divided_team_test.cc has their effect on teams.
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "agent/anti_entropy.h"
#include "tests/agent/driven_agent.h"

namespace ergocast {
namespace {

using namespace test;

std::vector<Eigen::Vector3d> path_of(std::int64_t steps) {
  return std::vector<Eigen::Vector3d>(static_cast<std::size_t>(steps), {700, 300, 0});
}

/// Agent 0's table and its AntiEntropy, in a team of five.
class Repair : public ::testing::Test {
 protected:
  /// Adds an entry; rosters ascend by author.
  void admit(const RosterEntry& entry) {
    roster.push_back(entry);
    std::sort(roster.begin(), roster.end(),
              [](const RosterEntry& a, const RosterEntry& b) { return a.author < b.author; });
  }
  /// Agent 0 has received `steps` of `author`, which broadcasts every `period` ticks.
  void hold(const Author& author, std::int64_t steps, Tick period = 1) {
    for (const Contribution& block :
         blocks_of(mission, author, path_of(steps), steps - 1 + period)) {
      ASSERT_EQ(table.merge(block, steps), Merge::kNewer);
    }
  }

  /// `from` reports in its next digest that it holds only `steps` of `author`.
  void complain(AgentId from, const Author& author, std::int64_t steps, Instant now) {
    Digest digest;
    digest.header = {kRun, from, incarnation_of(from), ++sequence, 0};
    digest.entry_count = 1;
    digest.entries[0] = {author, steps};
    repair.on(digest, table, roster, now, 0);
  }
  void complain_twice(AgentId from, const Author& author, std::int64_t steps, Instant now) {
    complain(from, author, steps, now);
    complain(from, author, steps, now + 1s);
  }

  /// The authors that it has decided to answer for by `now`, once the longest delay is over.
  std::vector<Author> answered(Instant now) {
    std::vector<Author> authors;
    for (const Contribution& block : repair.answers_due(table, now + 250ms, 0)) {
      authors.push_back(block.author());
    }
    return authors;
  }

  Mission mission = small_mission(5);
  CoverageTable table{mission.basis, mission.timing.dt_s};
  std::vector<RosterEntry> roster = roster_of(5);
  AntiEntropy repair{author_of(0), mission.seed, mission.timing.dt_s};
  std::int64_t sequence = 0;

  const std::vector<Author> nobody{};
  const std::vector<Author> two{author_of(2)};
};

// ---- digests ----

TEST_F(Repair, ADigestNamesAllOfTheRosterWithNothingForWhatIsNotHeld) {
  const Author former{3, 33};
  admit({former, 0, 4});
  hold(author_of(2), 9);
  hold(former, 4);
  const Digest digest = repair.digest(table, roster, 0);
  ASSERT_EQ(digest.entry_count, 6);
  for (std::size_t i = 0; i < roster.size(); ++i) {
    const DigestEntry& entry = digest.entries[i];
    EXPECT_EQ(entry.author, roster[i].author);
    EXPECT_EQ(entry.steps, entry.author == author_of(2) ? 9 : entry.author == former ? 4 : 0);
  }
}

TEST_F(Repair, ADigestNamesTheOldestBlockOfARow) {
  const Mission two_blocks = two_block_mission(2);
  CoverageTable large(two_blocks.basis, two_blocks.timing.dt_s);
  large.merge(blocks_of(two_blocks, author_of(1), path_of(8), 8)[0], 8);
  const auto steps_of_1 = [&] { return repair.digest(large, roster_of(2), 0).entries[1].steps; };
  EXPECT_EQ(steps_of_1(), 0) << "the second block has never come";
  large.merge(blocks_of(two_blocks, author_of(1), path_of(5), 5)[1], 8);
  EXPECT_EQ(steps_of_1(), 5);
}

TEST(AgentDigests, OnceASecond) {
  Agent agent = running_agent(small_mission(3));
  const auto digests_at = [&](Instant now) { return only<Digest>(advance(agent, now)); };
  const auto first = digests_at(at(0s));
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].header.sender, 0);
  EXPECT_EQ(first[0].header.incarnation, incarnation_of(0));
  EXPECT_EQ(first[0].entry_count, 3);
  EXPECT_TRUE(digests_at(at(999ms)).empty());
  EXPECT_LE(agent.next_wakeup(), at(1s));
  EXPECT_EQ(digests_at(at(1s)).size(), 1u);
}

TEST(AgentDigests, AndEachMissionSecondHoweverFastTheClockOfTheMission) {
  Agent agent = running_agent(small_mission(1));
  int digests = 0;
  for (Tick tick = 0; tick < 40; ++tick) {
    for (const Outgoing& outgoing : deliver(agent, world_state(tick, {{100, 500, 0}}), at(0s))) {
      const auto* digest = std::get_if<Digest>(&outgoing.message);
      if (digest == nullptr) continue;
      EXPECT_EQ(outgoing.bus, Bus::kSwarm);
      EXPECT_EQ(digest->header.tick, tick);
      EXPECT_EQ(digest->entries[0].steps, tick + 1) << "as of the tick that it has begun";
      ++digests;
    }
  }
  EXPECT_EQ(digests, 4) << "40 ticks of 0.1 s";
}

// ---- which gap is worth an answer ----

TEST_F(Repair, AnswersTheSecondOfTwoDigestsInARow) {
  hold(author_of(2), 20);
  complain(1, author_of(2), 0, at(0s));
  EXPECT_EQ(answered(at(0s)), nobody) << "its own next broadcast may mend it";
  complain(1, author_of(2), 0, at(1s));
  EXPECT_EQ(answered(at(1s)), two);
  EXPECT_EQ(answered(at(2s)), nobody) << "once";
  complain(1, author_of(2), 0, at(2s));
  EXPECT_EQ(answered(at(2s)), two) << "the answer was lost: the gap is still there";
}

TEST_F(Repair, DigestsThatAreNotInARowBeginAnew) {
  hold(author_of(2), 20);
  complain(1, author_of(2), 0, at(0s));
  complain(1, author_of(2), 20, at(1s));
  complain(1, author_of(2), 0, at(2s));
  EXPECT_EQ(answered(at(2s)), nobody) << "it had caught up in between";
  complain(1, author_of(2), 0, at(7001ms));
  EXPECT_EQ(answered(at(7001ms)), nobody) << "it had been cut off for longer than 5 s";
  complain(1, author_of(2), 0, at(8s));
  EXPECT_EQ(answered(at(8s)), two);
}

TEST_F(Repair, ARepeatedOrOvertakenDigestIsNoSecondOne) {
  hold(author_of(2), 20);
  complain(1, author_of(2), 0, at(0s));
  for (const std::int64_t back : {1, 2}) {
    sequence -= back;
    complain(1, author_of(2), 0, at(1s));
    EXPECT_EQ(answered(at(1s)), nobody);
  }
}

TEST_F(Repair, TwoPeriodsBehindIsNotBehind) {
  hold(author_of(2), 20, 3);
  complain_twice(1, author_of(2), 14, at(0s));
  EXPECT_EQ(answered(at(1s)), nobody) << "6 ticks: the next two broadcasts";
  complain_twice(1, author_of(2), 13, at(2s));
  EXPECT_EQ(answered(at(3s)), two);
}

TEST_F(Repair, AnyGapIsOneIfItsAuthorHasLeft) {
  hold(author_of(2), 20, 3);
  roster[2].active_until = 20;
  complain_twice(1, author_of(2), 19, at(0s));
  EXPECT_EQ(answered(at(1s)), two) << "it will not send again";
  complain_twice(1, author_of(2), 20, at(2s));
  EXPECT_EQ(answered(at(3s)), nobody);
}

TEST_F(Repair, NoAgentAnswersWithItsOwnRow) {
  hold(author_of(0), 20);
  complain_twice(1, author_of(0), 0, at(0s));
  EXPECT_EQ(answered(at(1s)), nobody) << "in lockstep, ticks depend on when that is sent";
}

TEST_F(Repair, NoAgentIsSentItsOwnRow) {
  hold(author_of(1), 20);
  complain_twice(1, author_of(1), 0, at(0s));
  EXPECT_EQ(answered(at(1s)), nobody);
}

TEST_F(Repair, ButAnAgentIsSentItsFormerIncarnations) {
  const Author former{1, 11};
  admit({former, 0, 20});
  hold(former, 20);
  complain_twice(1, former, 0, at(0s));
  EXPECT_EQ(answered(at(1s)), std::vector<Author>{former});
}

TEST_F(Repair, AnAgentThatKnowsNoMoreIsSilent) {
  complain_twice(1, author_of(2), 0, at(0s));
  EXPECT_EQ(answered(at(1s)), nobody) << "nothing is held";
  hold(author_of(2), 20);
  complain_twice(1, author_of(2), 50, at(2s));
  EXPECT_EQ(answered(at(3s)), nobody) << "the other knows more";
}

// ---- which agent answers, and when ----

TEST_F(Repair, AnAnswerIsEveryBlockOfTheRow) {
  mission = two_block_mission(5);
  table = CoverageTable(mission.basis, mission.timing.dt_s);
  hold(author_of(2), 20);
  complain_twice(1, author_of(2), 0, at(0s));
  EXPECT_EQ(answered(at(1s)), (std::vector<Author>{author_of(2), author_of(2)}));
  EXPECT_EQ(repair.relayed(), 2);
}

TEST_F(Repair, OneAnswerIsForAllThatLackIt) {
  hold(author_of(2), 20);
  for (const AgentId from : {1, 3, 4}) complain(from, author_of(2), 0, at(0s));
  for (const AgentId from : {1, 3, 4}) complain(from, author_of(2), 0, at(1s));
  EXPECT_EQ(answered(at(1s)), two);
}

TEST_F(Repair, AnAnswerWaitsARandomShareOfAQuarterOfASecond) {
  hold(author_of(2), 20);
  std::set<std::chrono::nanoseconds> delays;
  for (int round = 0; round < 40; ++round) {
    const Instant now = at(round * 10s);
    complain_twice(1, author_of(2), 0, now);
    const Instant due = repair.next_answer();
    delays.insert(due - (now + 1s));
    EXPECT_TRUE(repair.answers_due(table, due - 1ns, 0).empty());
    EXPECT_EQ(repair.answers_due(table, due, 0).size(), 1u);
    EXPECT_EQ(repair.next_answer(), Instant::max());
  }
  EXPECT_EQ(delays.size(), 40u) << "a new one each time";
  EXPECT_GE(*delays.begin(), 0ns);
  EXPECT_LT(*delays.begin(), 50ms);
  EXPECT_LE(*delays.rbegin(), 250ms);
  EXPECT_GT(*delays.rbegin(), 200ms);
}

TEST_F(Repair, TheShareIsAFunctionOfTheSeedAndTheAgent) {
  hold(author_of(2), 20);
  const auto due_of = [&](AgentId id, std::uint64_t seed) {
    repair = AntiEntropy(author_of(id), seed, mission.timing.dt_s);
    complain_twice(1, author_of(2), 0, at(0s));
    return repair.next_answer();
  };
  EXPECT_EQ(due_of(0, 7), due_of(0, 7));
  EXPECT_NE(due_of(0, 7), due_of(0, 8));
  EXPECT_NE(due_of(0, 7), due_of(3, 7)) << "or all would answer at once";
}

TEST_F(Repair, TheWaitPassesInMissionTimeToo) {
  hold(author_of(2), 20);
  complain_twice(1, author_of(2), 0, at(0s));
  EXPECT_TRUE(repair.answers_due(table, at(1s), 0).empty());
  EXPECT_EQ(repair.answers_due(table, at(1s), 2).size(), 1u) << "0.25 s are two ticks of 0.1 s";
}

TEST_F(Repair, ATeammatesAnswerIsEnough) {
  hold(author_of(2), 20);
  complain_twice(1, author_of(2), 0, at(0s));
  repair.on_relayed(block_of(mission, 2, path_of(20), 20), table);
  EXPECT_EQ(answered(at(1s)), nobody);
  EXPECT_EQ(repair.relayed(), 0);
}

TEST_F(Repair, ATeammatesOlderAnswerIsNot) {
  hold(author_of(2), 20);
  complain_twice(1, author_of(2), 0, at(0s));
  repair.on_relayed(block_of(mission, 2, path_of(19), 19), table);
  repair.on_relayed(block_of(mission, 3, path_of(20), 20), table);
  EXPECT_EQ(answered(at(1s)), two);
}

TEST_F(Repair, SendsWhatItHoldsAtThatTimeNotWhenItDecided) {
  hold(author_of(2), 20);
  complain_twice(1, author_of(2), 0, at(0s));
  hold(author_of(2), 25);
  const auto blocks = repair.answers_due(table, at(2s), 0);
  ASSERT_EQ(blocks.size(), 1u);
  EXPECT_EQ(blocks[0].steps, 25);
}

// ---- digests that cannot be true ----

TEST_F(Repair, StrangersInADigestAreIgnored) {
  const Author stranger{2, 4711};
  hold(stranger, 20);
  complain_twice(1, stranger, 0, at(0s));
  EXPECT_EQ(answered(at(1s)), nobody);
  complain_twice(1, author_of(3), std::numeric_limits<std::int64_t>::max(), at(2s));
  EXPECT_EQ(answered(at(3s)), nobody);
}

TEST_F(Repair, AFloodOfDigestsGetsNoMoreThanOneAnswerAtATime) {
  hold(author_of(2), 20);
  hold(author_of(3), 20);
  std::size_t blocks = 0;
  for (int ms = 0; ms < 10000; ++ms) {
    complain(1, author_of(2), 0, at(ms * 1ms));
    complain(1, author_of(3), 0, at(ms * 1ms));
    blocks += repair.answers_due(table, at(ms * 1ms), 0).size();
  }
  // Two authors for 10 s, with one answer each 0.125 s on average; the spread is 0.07 s · √80.
  EXPECT_LT(blocks, 2u * 100u);
}

TEST_F(Repair, NoMoreRowsAreTakenUpInASecondThanItsLimitWhateverDigestsList) {
  constexpr auto kMost = static_cast<int>(AntiEntropy::kMaxAnswers);
  std::vector<Author> gone;
  for (int i = 0; i <= kMost; ++i) gone.push_back({5 + i / 13, 5000 + static_cast<Incarnation>(i)});
  for (const Author& author : gone) admit({author, 0, 4});
  for (const Author& author : gone) hold(author, 9);
  const auto all_complain = [&](Instant now) {
    for (const Author& author : gone) complain(1, author, 0, now);
  };
  const auto rows_answered = [&](Instant now) {
    const auto authors = answered(now);
    return static_cast<int>(std::set<Author>(authors.begin(), authors.end()).size());
  };
  all_complain(at(0s));
  all_complain(at(1s));
  EXPECT_EQ(rows_answered(at(1s)), kMost) << "one of them waits";
  all_complain(at(1500ms));
  EXPECT_EQ(rows_answered(at(1500ms)), 0);
  all_complain(at(2s));
  EXPECT_EQ(rows_answered(at(2s)), kMost);
}

TEST_F(Repair, NoMoreRowsWaitToBeRepeatedThanItsLimitHoweverManySecondsPass) {
  constexpr auto kMost = static_cast<int>(AntiEntropy::kMaxAnswers);
  std::vector<Author> gone;
  for (int i = 0; i < kMost + 20; ++i)
    gone.push_back({5 + i / 13, 5000 + static_cast<Incarnation>(i)});
  for (const Author& author : gone) admit({author, 0, 4});
  for (const Author& author : gone) hold(author, 9);
  // Nothing is repeated in between, as if the agent's process were suspended.
  for (const Instant now : {at(0s), at(1s), at(2s), at(3s)}) {
    for (const Author& author : gone) complain(1, author, 0, now);
  }
  EXPECT_EQ(answered(at(3s)).size(), AntiEntropy::kMaxAnswers);
}

TEST_F(Repair, AnAgentThatHasComplainedAndLeftMakesRoomForOthers) {
  constexpr AgentId kMany = 128;
  roster = roster_of(kMany);
  for (AgentId id = 1; id < kMany; ++id) hold(author_of(id), 20);
  for (AgentId from = 3; from < kMany; ++from) {
    for (AgentId id = 1; id < kMany; ++id) complain(from, author_of(id), 0, at(0s));
  }
  complain_twice(1, author_of(2), 0, at(6s));
  EXPECT_EQ(answered(at(7s)), two);
}

TEST(AgentDigests, FromAgentsThatAreNoMembersAreIgnored) {
  Mission mission = small_mission(3);
  mission.timing.pace = Pace::kRealtime;
  Agent agent = running_agent(mission);
  give(agent, block_of(mission, 2, path_of(20), 20), at(0s));
  const auto answers_to = [&](const Author& from) {
    Digest digest;
    digest.entry_count = 1;
    digest.entries[0] = {author_of(2), 0};
    for (std::int64_t sequence = 1; sequence <= 5; ++sequence) {
      digest.header = {kRun, from.agent, from.incarnation, sequence, 0};
      give(agent, digest, at(1s));
    }
    return only<Contribution>(advance(agent, at(2s))).size();
  };
  EXPECT_EQ(answers_to({1, 4711}), 0u) << "a member's number, but no member's incarnation";
  EXPECT_EQ(answers_to({0, incarnation_of(1)}), 0u) << "a member's life under another number";
  EXPECT_EQ(answers_to(author_of(1)), 1u);
}

}  // namespace
}  // namespace ergocast
