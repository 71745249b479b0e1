// SPDX-License-Identifier: BSD-3-Clause
// ĉ on random tables, compared with its formula, and which agents count in it.
#include "core/law/forecast.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "tests/core/forecast_history.h"

namespace ergocast {
namespace {

using namespace test;

// ---- random histories ----

/// Changes one sum of a broadcast block to another value that its range still allows.
void forge(Contribution& block, Dice& dice) {
  const double elapsed_s = block.elapsed_s;
  block.sums.edit()[1 + dice.below(10)] = dice.one_in(2) ? elapsed_s : -elapsed_s;
}

/// Agent 2 and the own agent were restarted; one agent has left, one will come, one is not in the
/// roster.
std::vector<RosterEntry> drawn_roster(Dice& dice) {
  const Tick restarted = dice.tick(1, kEnd), ours = dice.tick(0, kEnd);
  std::vector<RosterEntry> roster{entry_of({0, 7}, 0, ours), entry_of(kSelf, ours)};
  roster.push_back(entry_of({1, 5}, 0));
  roster.push_back(entry_of({2, 1}, restarted));
  roster.push_back(entry_of({2, 0xffffffffffffffff}, 0, dice.one_in(2) ? restarted : -1));
  roster.push_back(entry_of({3, 4}, 0, dice.one_in(2) ? dice.tick(1, 2 * kEnd) : -1));
  roster.push_back(entry_of({4, 2}, dice.one_in(2) ? dice.tick(0, 2 * kEnd) : 0));
  if (dice.one_in(2)) roster.push_back(entry_of({5, 8}, dice.tick(0, kEnd)));
  return roster;
}

Known drawn(std::uint64_t history, const Mission& mission) {
  Dice dice(history);
  Known known;
  known.roster = drawn_roster(dice);
  known.joined = known.roster[1].active_from;
  known.tick = kEnd - 1 + (dice.one_in(4) ? dice.tick(0, 900) : 0);
  std::vector<Author> authors{{6, 3}};
  for (const RosterEntry& entry : known.roster) authors.push_back(entry.author);
  for (const Author& author : authors) {
    const auto entry = std::find_if(known.roster.begin(), known.roster.end(),
                                    [&](const RosterEntry& one) { return one.author == author; });
    const Tick from = entry == known.roster.end() ? 0 : entry->active_from;
    const Tick until = entry == known.roster.end() || entry->active_until < 0
                           ? kEnd
                           : std::min(kEnd, entry->active_until);
    const std::uint64_t deafness = 1 + dice.below(4);
    Life life(author, mission);
    for (Tick tick = from; tick < until; ++tick) {
      life.cover(tick);
      if (dice.one_in(3)) continue;
      for (Contribution& block :
           life.blocks(tick, dice.one_in(5) ? 1000 : dice.tick(1, kPeriod + 1))) {
        if (dice.one_in(12) && author != kSelf) forge(block, dice);
        if (dice.one_in(deafness)) known.heard.push_back(block);
        if (dice.one_in(6) && !known.heard.empty()) {
          known.heard.push_back(known.heard[dice.below(known.heard.size())]);
        }
      }
    }
    if (dice.one_in(8) && author != kSelf) known.forgotten.push_back(author);
  }
  for (const AgentId agent : {0, 1, 2, 3, 4, 5}) {
    const std::uint64_t rarely = 1 + dice.below(5);
    if (dice.one_in(5)) continue;
    const Tick until = dice.one_in(3) ? dice.tick(1, kEnd) : kEnd;
    for (Tick tick = std::max<Tick>(0, until - kPeriod - 64); tick < until; ++tick) {
      if (dice.one_in(rarely)) known.seen[agent].push_back(tick);
    }
  }
  return known;
}

struct Law {
  const char* name;
  bool dead_reckoning;
  double half_life_s;
};

class Foreseen : public ::testing::TestWithParam<Law> {
 protected:
  Foreseen() { mission_.law.memory_half_life_s = GetParam().half_life_s; }

  Mission mission_ = mission_of(GetParam().dead_reckoning);

  /// Looks at what is known in each of many histories.
  void in_every_history(const std::function<void(const Known&, Dice&)>& check) {
    for (std::uint64_t history = 0; history < kHistories; ++history) {
      SCOPED_TRACE("history " + std::to_string(history));
      Dice dice(1000 + history);
      check(drawn(history, mission_), dice);
    }
  }
};
INSTANTIATE_TEST_SUITE_P(Forecast, Foreseen,
                         ::testing::Values(Law{"WithDeadReckoning", true, 0},
                                           Law{"FromRowsAlone", false, 0},
                                           Law{"WithDeadReckoningForgetting", true, 1.3},
                                           Law{"FromRowsAloneForgetting", false, 1.3},
                                           Law{"WithDeadReckoningForgettingAtOnce", true, 0.1}),
                         [](const auto& law) { return std::string(law.param.name); });

TEST_P(Foreseen, IsTheFormula) {
  double largest = 0;
  in_every_history([&](const Known& known, Dice&) {
    const Coefficients expected = by_the_formula(known, mission_),
                       actual = foreseen(known, mission_);
    ASSERT_LT((actual - expected).cwiseAbs().maxCoeff(), 1e-12);
    Coefficients average(144);
    table_of(known, mission_).average(average);
    largest = std::max(largest, (actual - average).cwiseAbs().maxCoeff());
  });
  EXPECT_GT(largest, 0.1) << "or nothing was foreseen";
}

/// The same number of modes in six slabs. The second block begins within a row of the last slab.
TEST_P(Foreseen, IsTheFormulaInSpaceToo) {
  mission_.domain.origin_m.z() = -20;
  mission_.domain.size_m.z() = 400;
  mission_.basis.modes_x = 4;
  mission_.basis.modes_y = mission_.basis.modes_z = 6;
  in_every_history([&](const Known& known, Dice&) {
    ASSERT_LT((foreseen(known, mission_) - by_the_formula(known, mission_)).cwiseAbs().maxCoeff(),
              1e-12);
  });
}

/// Each vehicle is charged for some time, which half of them have not ended yet.
TEST_P(Foreseen, IsTheFormulaWhereBatteriesAreCharged) {
  mission_.kinds = {{.name = "robots", .count = 6, .battery = {.capacity_wh = 1}}};
  mission_.starts_m.assign(6, mission_.domain.center_m());
  int differ = 0;
  in_every_history([&](Known known, Dice& dice) {
    const Coefficients uncharged = foreseen(known, mission_);
    ASSERT_LT((uncharged - by_the_formula(known, mission_)).cwiseAbs().maxCoeff(), 1e-12);
    for (const auto& [agent, ticks] : known.seen) {
      const Tick from = dice.tick(0, kEnd), until = dice.one_in(2) ? kEnd : dice.tick(from, kEnd);
      for (const Tick tick : ticks)
        if (tick >= from && tick < until) known.charging.emplace(agent, tick);
    }
    const Coefficients actual = foreseen(known, mission_);
    ASSERT_LT((actual - by_the_formula(known, mission_)).cwiseAbs().maxCoeff(), 1e-12);
    differ += actual != uncharged;
  });
  EXPECT_GT(differ, 10);
}

TEST_P(Foreseen, IsAnAverageWhateverAnAgentClaims) {
  in_every_history([&](Known known, Dice& dice) {
    for (Contribution& block : known.heard) {
      if (dice.one_in(2)) forge(block, dice);
      if (dice.one_in(3)) block.header.tick = dice.one_in(2) ? -1 : Tick{1} << 48;
      if (dice.one_in(3)) block.next_broadcast_tick = dice.one_in(2) ? 0 : Tick{1} << 48;
    }
    const Coefficients coverage = foreseen(known, mission_);
    ASSERT_LT(coverage.cwiseAbs().maxCoeff(), 1 + 1e-9);
  });
}

TEST_P(Foreseen, IsWhatIsKnownWhereTheLawDoesNotLookAhead) {
  mission_.law.anticipation = 0;
  mission_.dead_reckoning = false;
  in_every_history([&](Known known, Dice&) {
    known.roster.clear();
    Coefficients average(144);
    table_of(known, mission_).average(average);
    ASSERT_LT((foreseen(known, mission_) - average).cwiseAbs().maxCoeff(), 1e-15);
  });
}

// ---- which agents count ----

/// The same without a forecast of agent 1; its coverage still counts.
Known without_hope_for_1(Known known) {
  known.roster.erase(known.roster.begin() + 1);
  return known;
}

TEST(ForecastCounts, NoAgentThatHasLeftOrIsYetToCome) {
  const Mission mission = mission_of(false);
  const Known team = team_of(3, mission);
  const Coefficients all = foreseen(team, mission),
                     rest = foreseen(without_hope_for_1(team), mission);
  EXPECT_NE(all, rest);
  for (const auto& [from, until, counts] : {std::tuple<Tick, Tick, bool>{0, -1, true},
                                            {0, kEnd, true},
                                            {0, kEnd - 1, false},
                                            {kEnd, -1, false}}) {
    Known known = team;
    known.roster[1] = entry_of({1, 1}, from, until);
    EXPECT_EQ(foreseen(known, mission), counts ? all : rest) << from << ' ' << until;
  }
}

TEST(ForecastCounts, OfOneNumberTheNewestIncarnationOnly) {
  const Mission mission = mission_of(false);
  const Known team = team_of(3, mission);
  // The order of the incarnations' numbers is random, so both orders are tested.
  for (const Incarnation newer : {Incarnation{0}, Incarnation{2}}) {
    Known known = team;
    const RosterEntry restarted = entry_of({1, newer}, 7);
    known.roster.insert(known.roster.begin() + (newer == 0 ? 1 : 2), restarted);
    EXPECT_EQ(foreseen(known, mission), foreseen(without_hope_for_1(team), mission)) << newer;
    // Until the newer one's first tick has come, the elder counts.
    known.roster[newer == 0 ? 1 : 2].active_from = kEnd;
    EXPECT_EQ(foreseen(known, mission), foreseen(team, mission)) << newer;
  }
}

TEST(ForecastCounts, NoAgentThatIsForgotten) {
  const Mission mission = mission_of(false);
  Known team = team_of(3, mission), known = team;
  known.forgotten = {{1, 1}};
  std::erase_if(team.heard, [](const Contribution& block) { return block.header.sender == 1; });
  EXPECT_EQ(foreseen(known, mission), foreseen(team, mission));
}

TEST(ForecastCounts, NoFormerIncarnationOfOurOwn) {
  const Mission mission = mission_of(false);
  Known known = team_of(3, mission);
  const Author former{0, 5};
  Life life(former, mission);
  for (Tick tick = 0; tick < 20; ++tick) life.cover(tick);
  for (const Contribution& block : life.blocks(19)) known.heard.push_back(block);
  const Coefficients expected = foreseen(known, mission);
  // This also holds if the roster does not contain its departure yet.
  for (const Tick until : {Tick{20}, Tick{-1}}) {
    Known named = known;
    named.roster[0].active_from = 20;
    named.roster.insert(named.roster.begin(), entry_of(former, 0, until));
    EXPECT_EQ(foreseen(named, mission), expected) << until;
  }
}

/// Agent 1's last message, in both blocks.
std::vector<Contribution*> last_words_of_1(Known& known) {
  std::vector<Contribution*> last(2);
  for (Contribution& block : known.heard) {
    if (block.header.sender == 1) last[static_cast<std::size_t>(block.block)] = &block;
  }
  return last;
}

TEST(ForecastCounts, NoAgentWhoseGainsAreImpossible) {
  const Mission mission = mission_of(false);
  Known known = team_of(3, mission);
  const std::vector<Contribution*> last = last_words_of_1(known);
  last[0]->sums.edit()[3] = -last[0]->sums[3];
  ASSERT_GT(std::abs(2 * last[0]->sums[3]), 2 * kDt) << "more than two ticks give";
  const Coefficients refused = foreseen(known, mission),
                     rest = foreseen(without_hope_for_1(known), mission);
  for (int k = 0; k < 144; ++k) {
    EXPECT_EQ(refused.data()[k] == rest.data()[k], k < kBlockSize)
        << "the other block is sound, " << k;
  }
}

TEST(ForecastCounts, AGainThatIsJustPossible) {
  const Mission mission = mission_of(false);
  Known known = team_of(3, mission);
  const std::vector<Contribution*> last_words = last_words_of_1(known);
  Contribution& last = *last_words[0];
  Life before({1, 1}, mission);
  for (Tick tick = 0; tick < kEnd - 1; ++tick) before.cover(tick);
  const std::vector<Contribution> sent_before = before.blocks(kEnd - 2);
  last.sums.edit()[3] = sent_before[0].sums[3] + kDt;
  EXPECT_LT((foreseen(known, mission) - by_the_formula(known, mission)).cwiseAbs().maxCoeff(),
            1e-12);
  EXPECT_NE(foreseen(known, mission), foreseen(without_hope_for_1(known), mission));
  last.sums.edit()[3] = sent_before[0].sums[3] + 1.001 * kDt;
  EXPECT_EQ(foreseen(known, mission)[3], foreseen(without_hope_for_1(known), mission)[3]);
}

TEST(ForecastCounts, AgentsThatHaveBeenSilentForTooLongInTheTeamsNumberOnly) {
  Mission mission = mission_of(false);
  mission.law.anticipation *= 2;  // beyond the age of the last block of agent 1
  Known known = team_of(3, mission);
  std::erase_if(known.heard, [](const Contribution& block) {
    return block.header.sender == 1 && block.header.tick > 2;
  });
  Known later = known;
  later.tick = kEnd + 900;
  for (const AgentId id : {0, 2}) {
    for (Contribution& block : later.heard) {
      if (block.header.sender == id) block.header.tick += 901;
    }
  }
  // Agent 2 continues with the horizon of a team of three.
  Known alone = without_hope_for_1(later);
  Mission longer = mission;
  const double dimensions = shared_dimensions(
      target_covariance_m2(mission.target_coefficients, mission.basis, mission.domain));
  longer.law.anticipation *= std::pow(2.0 / 3, 1 / dimensions);
  EXPECT_LT((foreseen(later, mission) - foreseen(alone, longer)).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_NE(foreseen(known, mission), foreseen(without_hope_for_1(known), longer))
      << "at first it counts";
}

TEST(ForecastCounts, NoPeriodThatThePlanDoesNotAllow) {
  const Mission mission = mission_of(false);
  Known honest = team_of(3, mission, kPeriod);
  std::erase_if(honest.heard, [](const Contribution& block) {
    return block.header.sender == 1 && block.header.tick > 10;
  });
  for (const Tick tick : {Tick{15}, Tick{59}, Tick{80}, Tick{500}}) {
    Known forged = honest;
    forged.tick = honest.tick = tick;
    for (Contribution& block : forged.heard) {
      if (block.header.sender == 1) block.next_broadcast_tick = block.header.tick + 1000;
    }
    EXPECT_EQ(foreseen(forged, mission), foreseen(honest, mission)) << tick;
  }
}

TEST(ForecastCounts, ABlockThatClaimsTheFutureAsOneOfNow) {
  const Mission mission = mission_of(false);
  const Known now = team_of(3, mission);
  for (const Tick later : {Tick{1}, Tick{30}, Tick{1} << 48}) {
    Known future = now;
    for (Contribution* block : last_words_of_1(future)) {
      block->header.tick += later;
      block->next_broadcast_tick += later;
    }
    EXPECT_EQ(foreseen(future, mission), foreseen(now, mission)) << later;
  }
}

TEST(ForecastBefore, IsNoBlockFromBeforeOneTookPart) {
  // An agent with more data of the time before must forecast the same.
  const Mission mission = mission_of(false);
  Known little = team_of(3, mission, kPeriod);
  little.joined = kEnd - 7;
  Known much = little;
  std::erase_if(little.heard,
                [&](const Contribution& block) { return block.header.tick < little.joined; });
  ASSERT_LT(little.heard.size(), much.heard.size());
  EXPECT_EQ(foreseen(little, mission), foreseen(much, mission));
  EXPECT_LT((foreseen(much, mission) - by_the_formula(much, mission)).cwiseAbs().maxCoeff(), 1e-12);
  // The next is compared with the first.
  much.joined = kEnd - 6 - kPeriod;
  EXPECT_NE(foreseen(little, mission), foreseen(much, mission));
}

}  // namespace
}  // namespace ergocast
