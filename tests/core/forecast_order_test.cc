// SPDX-License-Identifier: BSD-3-Clause
// What ĉ must not depend on: the order of blocks and places, and mere claims of an author.
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "core/law/forecast.h"
#include "core/law/lost_places.h"
#include "tests/core/forecast_history.h"

namespace ergocast {
namespace {

using namespace test;

TEST(ForecastOrder, OldRepeatedAndRelayedBlocksChangeNothing) {
  // As in lockstep: every due block comes before its author's next.
  const Mission mission = mission_of(false);
  const Known team = team_of(4, mission, 3);
  for (std::uint64_t round = 0; round < 20; ++round) {
    Dice dice(round);
    Known noisy = team;
    noisy.heard.clear();
    CoverageTable relay(mission.basis, kDt);
    for (const Contribution& block : team.heard) {
      relay.merge(block, kManySteps);
      noisy.heard.push_back(dice.one_in(2) ? block : relay.block(block.author(), block.block));
      if (noisy.heard.back().steps < block.steps) noisy.heard.push_back(block);
      while (dice.one_in(2)) {
        Contribution again = noisy.heard[dice.below(noisy.heard.size())];
        again.header.sequence += 1000;
        noisy.heard.push_back(again);
      }
    }
    EXPECT_GT(noisy.heard.size(), team.heard.size());
    EXPECT_EQ(foreseen(noisy, mission), foreseen(team, mission)) << "bit for bit";
  }
}

/// Sees the places of `agents` vehicles at `tick`.
void see_all(Forecast& forecast, int agents, Tick tick, const Mission& mission) {
  for (AgentId id = 0; id < agents; ++id) forecast.see(id, tick, place(id, tick, mission));
}

TEST(DeadReckoning, RowsAreAsGoodAsIfTheyWereSentEachTickBitForBit) {
  const Mission mission = mission_of(true);
  const Known often = team_of(4, mission), seldom = team_of(4, mission, 10);
  Forecast by_words(mission, kSelf), by_places(mission, kSelf);
  CoverageTable announced(mission.basis, kDt), dead_reckoned(mission.basis, kDt);
  const auto receive = [](CoverageTable& table, const Known& team, Tick tick, bool all) {
    for (const Contribution& block : team.heard) {
      if (block.header.tick == tick && (all || block.header.sender == 0))
        table.merge(block, kManySteps);
    }
  };
  for (Tick tick = 0; tick < kEnd; ++tick) {
    receive(announced, often, tick, true);
    receive(dead_reckoned, often, tick, false);
    receive(dead_reckoned, seldom, tick, true);
    see_all(by_words, 4, tick, mission);
    see_all(by_places, 4, tick, mission);
    Coefficients words(144), places(144);
    by_words.look_ahead(announced, often.roster, tick, words);
    by_places.look_ahead(dead_reckoned, seldom.roster, tick, places);
    ASSERT_EQ(words, places) << tick;
  }
}

TEST(DeadReckoning, DoesNotDependOnWhenPlacesAndBlocksComeNorOnWhenOneLooks) {
  const Mission mission = mission_of(true);
  const Known team = team_of(4, mission, 7);
  Known all = team;
  // Some places are missed, so that the extended row differs from the next block.
  const auto is_seen = [](AgentId id, Tick tick) { return tick % 4 != id; };
  for (const AgentId id : {1, 2, 3}) {
    for (Tick tick = 0; tick < kEnd; ++tick) {
      if (is_seen(id, tick)) all.seen[id].push_back(tick);
    }
  }
  const Coefficients expected = foreseen(all, mission);
  EXPECT_LT((expected - by_the_formula(all, mission)).cwiseAbs().maxCoeff(), 1e-12);
  for (std::uint64_t round = 0; round < 20; ++round) {
    Dice dice(round);
    Forecast forecast(mission, kSelf);
    CoverageTable table(mission.basis, kDt);
    auto block = team.heard.begin();
    std::map<AgentId, Tick> next;
    Coefficients coverage(144);
    bool more = true;
    while (more) {
      if (block != team.heard.end() && dice.one_in(3)) table.merge(*block++, kManySteps);
      const AgentId id = 1 + static_cast<AgentId>(dice.below(3));
      if (next[id] < kEnd && dice.one_in(2)) {
        if (is_seen(id, next[id])) forecast.see(id, next[id], place(id, next[id], mission));
        ++next[id];
      }
      if (dice.one_in(10)) forecast.look_ahead(table, team.roster, kEnd - 1, coverage);
      more = block != team.heard.end() || next[1] < kEnd || next[2] < kEnd || next[3] < kEnd;
    }
    forecast.look_ahead(table, team.roster, kEnd - 1, coverage);
    EXPECT_EQ(coverage, expected) << "bit for bit, round " << round;
  }
}

TEST(DeadReckoning, PutsLostPlacesOntoTheLineBetweenOthers) {
  const Mission mission = mission_of(true);
  const Known team = team_of(2, mission, 1000);
  const CoverageTable table = table_of(team, mission);
  const auto x_m = [](Tick tick) {
    return Eigen::Vector3d(100 + 3.0 * static_cast<double>(tick), 300, 0);
  };
  const auto foreseen = [&](const std::function<bool(Tick)>& is_seen) {
    Forecast forecast(mission, kSelf);
    for (Tick tick = 0; tick <= 40; ++tick) {
      if (is_seen(tick)) forecast.see(1, tick, x_m(tick));
    }
    Coefficients coverage(144);
    forecast.look_ahead(table, team.roster, 40, coverage);
    return coverage;
  };
  const Coefficients all = foreseen([](Tick) { return true; });
  const auto lost = [](Tick first, Tick count) {
    return [=](Tick tick) { return tick < first || tick >= first + count; };
  };
  EXPECT_LT((foreseen(lost(20, 1)) - all).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LT((foreseen(lost(20, kMostLostPlaces)) - all).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_GT((foreseen(lost(20, kMostLostPlaces + 1)) - all).cwiseAbs().maxCoeff(), 1e-6);
}

/// ĉ after the team has sent everything up to tick 20, and `seen` has shown agent 1's vehicle at
/// 30.
Coefficients with_a_place(const Mission& mission, const Known& announced,
                          const std::function<void(Forecast&)>& seen) {
  Forecast forecast(mission, kSelf);
  seen(forecast);
  Coefficients coverage(144);
  forecast.look_ahead(table_of(announced, mission), announced.roster, 30, coverage);
  return coverage;
}

Known announced_until(Tick last, const Mission& mission) {
  Known known = team_of(3, mission);
  std::erase_if(known.heard,
                [last](const Contribution& block) { return block.header.tick > last; });
  return known;
}

TEST(DeadReckoning, UsesNoPlacesThatAreNone) {
  const Mission mission = mission_of(true);
  const Known announced = announced_until(20, mission);
  const auto here = place(1, 30, mission);
  const Coefficients blind = with_a_place(mission, announced, [](Forecast&) {});
  EXPECT_NE(with_a_place(mission, announced, [&](Forecast& f) { f.see(1, 30, here); }), blind);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<const char*, std::function<void(Forecast&)>>> none = {
      {"our own", [&](Forecast& f) { f.see(0, 30, here); }},
      {"outside",
       [&](Forecast& f) {
         f.see(1, 30, {-101, 100, 0});
       }},
      {"nowhere",
       [&](Forecast& f) {
         f.see(1, 30, {nan, 100, 0});
       }},
      {"a stranger's", [&](Forecast& f) { f.see(7, 30, here); }},
      {"nobody's",
       [&](Forecast& f) {
         f.see(-3, 30, here);
         f.see(kMaxAgents, 30, here);
       }},
      {"known already", [&](Forecast& f) { f.see(1, 19, here); }},
  };
  for (const auto& [name, seen] : none)
    EXPECT_EQ(with_a_place(mission, announced, seen), blind) << name;
  Mission by_rows = mission;
  by_rows.dead_reckoning = false;
  EXPECT_EQ(with_a_place(by_rows, announced, [&](Forecast& f) { f.see(1, 30, here); }), blind)
      << "not wanted";
}

TEST(DeadReckoning, UsesNoPlaceTwiceNorOneOfAnEarlierTick) {
  const Mission mission = mission_of(true);
  const Known announced = announced_until(20, mission);
  const auto seen = [&](std::vector<std::pair<Tick, Tick>> said_and_true) {
    return with_a_place(mission, announced, [&](Forecast& f) {
      for (const auto& [sent, actual] : said_and_true) f.see(1, sent, place(1, actual, mission));
    });
  };
  const Coefficients once = seen({{21, 21}, {25, 25}});
  EXPECT_EQ(seen({{21, 21}, {21, 3}, {25, 25}, {25, 4}}), once);
  EXPECT_EQ(seen({{21, 21}, {25, 25}, {23, 23}}), once);
}

TEST(DeadReckoning, UsesNoPlaceOfAFormerAuthorsTime) {
  // Agent 1 was restarted at tick 22: its vehicle's earlier places belong to its predecessor.
  const Mission mission = mission_of(true);
  Known announced = announced_until(20, mission);
  announced.roster[1].active_until = 22;
  announced.roster.insert(announced.roster.begin() + 2, entry_of({1, 5}, 22));
  Life restarted({1, 5}, mission);
  for (Tick tick = 22; tick < 24; ++tick) restarted.cover(tick);
  for (const Contribution& block : restarted.blocks(23)) announced.heard.push_back(block);
  const auto see_from = [&](Tick first) {
    return with_a_place(mission, announced, [&](Forecast& forecast) {
      Coefficients looked(144);
      for (Tick tick = first; tick <= 30; ++tick) {
        forecast.see(1, tick, place(1, tick, mission));
        // While the former author was the newest, its row was extended on the same track.
        Known then = announced_until(std::min<Tick>(tick, 20), mission);
        forecast.look_ahead(table_of(then, mission), tick < 22 ? then.roster : announced.roster,
                            tick, looked);
      }
    });
  };
  EXPECT_EQ(see_from(0), see_from(24));
  announced.tick = 30;
  for (Tick tick = 0; tick <= 30; ++tick) announced.seen[1].push_back(tick);
  EXPECT_LT((see_from(0) - by_the_formula(announced, mission)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(DeadReckoning, UsesNoPlaceOfAnAdmissionThatIsNoMore) {
  // A coordinator crashed, and its successor admitted agent 1 again, from tick 26 on.
  const Mission mission = mission_of(true);
  const Known announced = announced_until(20, mission);
  Known anew = announced;
  anew.roster[1].active_from = 26;
  const auto after = [&](const std::vector<RosterEntry>& before) {
    return with_a_place(mission, anew, [&](Forecast& forecast) {
      Coefficients looked(144);
      for (Tick tick = 0; tick < 24; ++tick) forecast.see(1, tick, place(1, tick, mission));
      forecast.look_ahead(table_of(announced, mission), before, 24, looked);
      forecast.see(1, 27, place(1, 27, mission));
    });
  };
  EXPECT_EQ(after(announced.roster), after(anew.roster));
  EXPECT_NE(after(announced.roster), foreseen(announced, mission));
}

TEST(DeadReckoning, BeginsAnewAfterAPause) {
  // Agent 1 was forgotten for longer than its places are kept.
  const Mission mission = mission_of(true);
  const Known announced = announced_until(20, mission);
  CoverageTable without = table_of(announced, mission);
  without.forget({1, 1});
  const auto after = [&](bool looked_before) {
    return with_a_place(mission, announced, [&](Forecast& forecast) {
      Coefficients looked(144);
      for (Tick tick = 0; tick < 24; ++tick) forecast.see(1, tick, place(1, tick, mission));
      if (looked_before) {
        forecast.look_ahead(table_of(announced, mission), announced.roster, 24, looked);
        forecast.look_ahead(without, announced.roster, 25, looked);
      }
      for (Tick tick = 25; tick < 200; ++tick) forecast.see(1, tick, place(1, tick, mission));
    });
  };
  EXPECT_EQ(after(true), after(false));
}

TEST(DeadReckoning, LeavesWhatIsKnownAndPassedOnAsItWas) {
  const Mission mission = mission_of(true);
  const Known announced = announced_until(20, mission);
  const CoverageTable before = table_of(announced, mission);
  CoverageTable table = before;
  Forecast forecast(mission, kSelf);
  Coefficients foreseen(144), known(144), known_before(144);
  before.average(known_before);
  for (Tick tick = 21; tick < kEnd; ++tick) {
    see_all(forecast, 3, tick, mission);
    forecast.look_ahead(table, announced.roster, tick, foreseen);
    table.average(known);
    ASSERT_EQ(known, known_before);
    ASSERT_NE(foreseen, known);
    for (const AgentId id : {1, 2}) {
      const Contribution now = table.block({id, 1}, 0), then = before.block({id, 1}, 0);
      ASSERT_TRUE(now.steps == then.steps && now.sums == then.sums &&
                  now.header.tick == then.header.tick);
    }
  }
}

}  // namespace
}  // namespace ergocast
