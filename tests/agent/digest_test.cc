// SPDX-License-Identifier: BSD-3-Clause
// Which entries of a large roster a digest names: those that seem to be lacking, and all in turn.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "agent/anti_entropy.h"
#include "tests/agent/driven_agent.h"

namespace ergocast {
namespace {

using namespace test;

/// Agent 0 of a team. All agents are at tick 19 and have announced their next blocks for tick 20.
struct Speaker {
  explicit Speaker(int members) : roster(roster_of(members)) {
    for (const RosterEntry& entry : roster) hold(entry.author, 20);
  }
  void hold(const Author& author, std::int64_t steps) {
    const std::vector<Eigen::Vector3d> path(static_cast<std::size_t>(steps), {700, 300, 0});
    for (const Contribution& block : blocks_of(mission, author, path, steps)) {
      table.merge(block, steps);
    }
  }
  void admit_former(const Author& author) {
    roster.push_back({author, 0, 4});
    std::sort(roster.begin(), roster.end(),
              [](const RosterEntry& a, const RosterEntry& b) { return a.author < b.author; });
  }
  std::vector<Author> named(Tick tick = 19) {
    const Digest digest = repair.digest(table, roster, tick);
    std::vector<Author> authors;
    for (int i = 0; i < digest.entry_count; ++i) {
      authors.push_back(digest.entries[static_cast<std::size_t>(i)].author);
    }
    EXPECT_TRUE(std::is_sorted(authors.begin(), authors.end())) << "receivers walk along";
    return authors;
  }
  bool names(const Author& author, Tick tick = 19) {
    const auto all = named(tick);
    return std::find(all.begin(), all.end(), author) != all.end();
  }
  std::uint64_t settled() { return repair.digest(table, roster, 19).settled_hash; }

  Mission mission = small_mission(2);
  CoverageTable table{mission.basis, mission.timing.dt_s};
  std::vector<RosterEntry> roster;
  AntiEntropy repair{author_of(0), mission.seed, mission.timing.dt_s};
};

TEST(DigestOfATeam, OfUpToFortyEntriesNamesAll) {
  for (const int members : {1, 39, 40}) {
    Speaker speaker(members);
    for (int turn = 0; turn < 3; ++turn) {
      EXPECT_EQ(speaker.named().size(), static_cast<std::size_t>(members));
    }
    EXPECT_EQ(AntiEntropy::round_s(static_cast<std::size_t>(members)), 1);
  }
}

TEST(DigestOfATeam, OfMoreNamesAllWithinARoundWhateverItLacks) {
  for (const int members : {41, 100, 1000}) {
    for (const Tick tick : {19, 40}) {  // at the latter all blocks are overdue
      Speaker speaker(members);
      const auto round = static_cast<int>(AntiEntropy::round_s(speaker.roster.size()));
      std::set<Author> named;
      for (int turn = 0; turn < round; ++turn) {
        const auto now = speaker.named(tick);
        EXPECT_LE(now.size(), static_cast<std::size_t>(kMaxDigestEntriesPerMessage));
        named.insert(now.begin(), now.end());
      }
      EXPECT_EQ(named.size(), static_cast<std::size_t>(members)) << tick;
    }
  }
  EXPECT_EQ(AntiEntropy::round_s(1000), 50);
  EXPECT_EQ(AntiEntropy::round_s(kMaxRosterEntries), 205);
}

TEST(DigestOfATeam, NamesAllWithinARoundAlsoWhileOthersComeAndGo) {
  Speaker speaker(101);
  // The first twenty are overdue and take their half of each digest.
  for (std::size_t i = 20; i < speaker.roster.size(); ++i) {
    speaker.hold(speaker.roster[i].author, 40);
  }
  for (int turn = 0; turn < 51; ++turn) speaker.named(39);
  const RosterEntry one = speaker.roster.back();
  std::set<Author> named;
  for (int turn = 0; turn < AntiEntropy::round_s(101); ++turn) {
    turn % 2 == 0 ? speaker.roster.pop_back() : speaker.roster.push_back(one);
    const auto now = speaker.named(39);
    named.insert(now.begin(), now.end());
  }
  EXPECT_GE(named.size(), 100u);
}

TEST(DigestOfATeam, NamesEachTimeWhatIsOverdueOrWasNeverReceived) {
  Speaker speaker(1000);
  const Author newcomer{700, 4711};
  speaker.roster[700].active_until = 3;
  speaker.roster.insert(speaker.roster.begin() + 701, {newcomer, 5, -1});
  for (const RosterEntry& entry : speaker.roster) {
    if (entry.author != author_of(900) && entry.author != newcomer) speaker.hold(entry.author, 40);
  }
  for (int turn = 0; turn < 30; ++turn) {
    EXPECT_TRUE(speaker.names(author_of(900), 39)) << turn;
    EXPECT_TRUE(speaker.names(newcomer, 39)) << turn;
  }
}

TEST(DigestOfATeam, NamesFormerMembersFirstWhileATeammateHoldsSomethingElseOfThem) {
  Speaker speaker(1000), teammate(1000);
  for (AgentId id = 500; id < 510; ++id) {
    const Author former{id, 77};
    for (Speaker* one : {&speaker, &teammate}) one->admit_former(former);
    teammate.hold(former, 4);
  }
  EXPECT_NE(speaker.settled(), teammate.settled());
  for (int turn = 0; turn < 5; ++turn) {
    Digest theirs = teammate.repair.digest(teammate.table, teammate.roster, 19);
    theirs.header = {kRun, 3, incarnation_of(3), turn + 1, 0};
    speaker.repair.on(theirs, speaker.table, speaker.roster, at(turn * 1s), 19);
    const auto named = speaker.named();
    const auto former = std::count_if(named.begin(), named.end(),
                                      [](const Author& one) { return one.incarnation == 77; });
    EXPECT_EQ(former, 10) << turn;
  }
  for (AgentId id = 500; id < 510; ++id) speaker.hold({id, 77}, 4);
  EXPECT_EQ(speaker.settled(), teammate.settled()) << "however far the living are";
}

TEST(DigestOfATeam, HasAnotherHashForEachFormerMemberThatMoreIsHeldOf) {
  Speaker speaker(3);
  const Author first{0, 1}, middle{1, 77}, last{2, ~Incarnation{0}};
  for (const Author& former : {first, middle, last}) speaker.admit_former(former);
  ASSERT_EQ(speaker.roster.front().author, first);
  ASSERT_EQ(speaker.roster.back().author, last);
  std::set<std::uint64_t> hashes{speaker.settled()};
  for (const Author& former : {first, middle, last}) {
    speaker.hold(former, 4);
    EXPECT_TRUE(hashes.insert(speaker.settled()).second) << former.agent;
  }
}

}  // namespace
}  // namespace ergocast
