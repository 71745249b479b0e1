// SPDX-License-Identifier: BSD-3-Clause
// ĉ on random tables, compared with its formula evaluated again from all received blocks; and what
// it must not depend on: the order of the blocks, and mere claims of an author.
#include "core/forecast.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>

#include "core/noise.h"

namespace ergocast {
namespace {

constexpr double kDt = 0.1;
constexpr std::int64_t kManySteps = 1000000;
constexpr std::uint64_t kHistories = 60;
constexpr Tick kPeriod = 5, kEnd = 60;
const Author kSelf{0, 9};

/// 12 × 12 modes: two blocks, the second not full.
Mission mission_of(bool dead_reckoning) {
  Mission mission;
  mission.domain = {{-100, 30, 0}, {2000, 1000, 0}};
  mission.basis.modes_x = mission.basis.modes_y = 12;
  mission.target_coefficients = Coefficients::Zero(144);
  mission.target_coefficients[0] = 1;
  mission.target_coefficients[24] = -0.3;
  mission.law.u_max_mps = 100;
  mission.law.anticipation = 2;
  mission.timing.dt_s = kDt;
  mission.timing.tick_count = 1000;
  mission.timing.broadcast_period_ticks = kPeriod;
  mission.dead_reckoning = dead_reckoning;
  return mission;
}

/// Numbers of one history.
class Dice {
 public:
  explicit Dice(std::uint64_t history) : history_(history) {}
  std::uint64_t below(std::uint64_t limit) {
    return random_words(history_, Purpose::kFault, 2, ++throws_).first % limit;
  }
  bool one_in(std::uint64_t many) { return below(many) == 0; }
  Tick tick(Tick from, Tick until) {
    return from + static_cast<Tick>(below(static_cast<std::uint64_t>(until - from)));
  }

 private:
  std::uint64_t history_, throws_ = 0;
};

/// Where the vehicle of `agent` is.
Eigen::Vector3d place(AgentId agent, Tick tick, const Mission& mission) {
  return uniform_in(mission.domain, 11, Purpose::kStart, static_cast<std::uint32_t>(agent),
                    static_cast<std::uint64_t>(tick));
}

/// An agent that covers the place of its vehicle, tick by tick, and broadcasts when it is asked to.
class Life {
 public:
  Life(const Author& author, const Mission& mission)
      : author_(author), mission_(mission), own_(mission.basis, kDt) {}
  void cover(Tick tick) {
    own_.add_sample(author_,
                    BasisAt(place(author_.agent, tick, mission_), mission_.domain, mission_.basis));
  }
  std::vector<Contribution> speak(Tick tick, Tick period = kPeriod) const {
    std::vector<Contribution> said;
    for (int b = 0; b < own_.block_count(); ++b) {
      said.push_back(own_.block(author_, b));
      said.back().header.tick = tick;
      said.back().next_broadcast_tick = tick + period;
    }
    return said;
  }

 private:
  Author author_;
  const Mission& mission_;
  CoverageTable own_;
};

/// All that one agent can know at a tick.
struct Known {
  std::vector<Contribution> heard;  // in the order of arrival
  std::vector<RosterEntry> roster;  // ascending by author
  std::vector<Author> forgotten;
  std::map<AgentId, std::vector<Tick>> seen;  // ascending
  Tick joined = 0, tick = 0;
};

CoverageTable table_of(const Known& known, const Mission& mission) {
  CoverageTable table(mission.basis, kDt, known.joined);
  for (const Contribution& block : known.heard) table.merge(block, kManySteps);
  for (const Author& author : known.forgotten) table.forget(author);
  return table;
}

Coefficients foreseen(const Known& known, const Mission& mission) {
  Forecast forecast(mission, kSelf);
  for (const auto& [agent, ticks] : known.seen) {
    for (const Tick tick : ticks) forecast.see(agent, tick, place(agent, tick, mission));
  }
  Coefficients coverage = Coefficients::Constant(144, 77);
  forecast.look_ahead(table_of(known, mission), known.roster, known.tick, coverage);
  return coverage;
}

// ---- the formula, again ------------------------------------------------------------------------

struct Row {
  std::int64_t steps = 0, gained_steps = 0;
  Tick tick = 0, period = 0;
  std::vector<double> sums = std::vector<double>(kBlockSize), gains = sums;
};

/// What is held of each author and block, and what it has gained since the one held before.
std::map<std::pair<Author, int>, Row> rows_of(const Known& known) {
  std::map<std::pair<Author, int>, Row> rows;
  for (const Contribution& said : known.heard) {
    Row& row = rows[{said.author(), said.block}];
    if (said.steps <= row.steps) continue;
    const bool has_before = row.steps > 0 && row.tick >= known.joined;
    const std::int64_t before = has_before ? row.steps : 0;
    bool possible = true;
    for (std::size_t k = 0; k < kBlockSize; ++k) {
      row.gains[k] = said.sums[k] - (has_before ? row.sums[k] : 0);
      row.sums[k] = said.sums[k];
      possible &=
          std::abs(row.gains[k]) < static_cast<double>(said.steps - before) * kDt * (1 + 1e-6);
    }
    row.steps = said.steps;
    row.gained_steps = possible ? said.steps - before : 0;
    row.tick = said.header.tick;
    row.period = said.next_broadcast_tick - said.header.tick;
  }
  return rows;
}

bool flies(const Author& author, const Known& known) {
  const RosterEntry* own = nullptr;
  for (const RosterEntry& entry : known.roster) {
    if (entry.author == author && entry.active_at(known.tick)) own = &entry;
  }
  return own != nullptr && author != kSelf &&
         std::none_of(known.roster.begin(), known.roster.end(), [&](const RosterEntry& entry) {
           return entry.author.agent == author.agent && entry.active_from <= known.tick &&
                  entry.active_from > own->active_from;
         });
}

/// Adds where the author's vehicle has been since it spoke.
void reckon(const Author& author, int block, const Known& known, const Mission& mission, Row& row) {
  const auto seen = known.seen.find(author.agent);
  if (seen == known.seen.end() || author.agent == kSelf.agent || row.steps == 0) return;
  const auto entry = std::find_if(known.roster.begin(), known.roster.end(),
                                  [&](const RosterEntry& one) { return one.author == author; });
  for (const Tick tick : seen->second) {
    if (tick < row.tick || !entry->active_at(tick)) continue;
    const Coefficients f =
        basis_values(place(author.agent, tick, mission), mission.domain, mission.basis);
    std::fill(row.gains.begin(), row.gains.end(), 0);
    for (int k = block * kBlockSize;
         k < std::min((block + 1) * kBlockSize, mission.basis.mode_count()); ++k) {
      const auto at = static_cast<std::size_t>(k - block * kBlockSize);
      row.gains[at] = f.data()[k] * kDt;
      if (tick > row.tick) row.sums[at] += f.data()[k] * kDt;
    }
    row.gained_steps = 1;
    row.steps += tick > row.tick;
    row.tick = tick;
  }
}

double weight_s(const Row& row, double horizon_s, Tick now) {
  const double cap_s = 8 * kDt * static_cast<double>(std::min(row.period, kPeriod));
  const double age_s = kDt * static_cast<double>(now - row.tick);
  if (age_s > std::max(horizon_s, cap_s)) return 0;
  return horizon_s + std::min(kDt * static_cast<double>(row.gained_steps), cap_s) + age_s;
}

Coefficients by_the_formula(const Known& known, const Mission& mission) {
  const double spread_m =
      target_spread_m(mission.target_coefficients, mission.basis, mission.domain);
  Coefficients foreseen = Coefficients::Zero(144);
  auto rows = rows_of(known);
  for (int b = 0; b < 2; ++b) {
    int n = 1;
    std::vector<Row*> counting, flying;
    for (auto& [key, row] : rows) {
      const auto& [author, block] = key;
      const bool forgotten = std::count(known.forgotten.begin(), known.forgotten.end(), author) > 0;
      if (block != b || forgotten) continue;
      counting.push_back(&row);
      if (!flies(author, known)) continue;
      if (mission.dead_reckoning) reckon(author, b, known, mission, row);
      if (row.gained_steps == 0) continue;
      flying.push_back(&row);
      ++n;
    }
    const double horizon_s =
        mission.law.anticipation * spread_m / (mission.law.u_max_mps * std::sqrt(n));
    for (int k = b * kBlockSize; k < std::min((b + 1) * kBlockSize, 144); ++k) {
      const auto at = static_cast<std::size_t>(k - b * kBlockSize);
      double above = 0, below_s = 0;
      for (const Row* row : counting) {
        above += row->sums[at];
        below_s += static_cast<double>(row->steps) * kDt;
      }
      for (const Row* row : flying) {
        const double w_s = weight_s(*row, horizon_s, known.tick);
        above += w_s * row->gains[at] / (static_cast<double>(row->gained_steps) * kDt);
        below_s += w_s;
      }
      if (below_s > 0) foreseen.data()[k] = above / below_s;
    }
  }
  return foreseen;
}

// ---- random histories --------------------------------------------------------------------------

/// Changes one sum of a broadcast block to another value that its range still allows.
void forge(Contribution& block, Dice& dice) {
  const double elapsed_s = static_cast<double>(block.steps) * kDt;
  block.sums.edit()[1 + dice.below(10)] = dice.one_in(2) ? elapsed_s : -elapsed_s;
}

RosterEntry entry_of(const Author& author, Tick from, Tick until = -1) {
  return {author, from, until};
}

/// Agent 2 and we were restarted; one agent has left, one is to come, one is not in the roster.
std::vector<RosterEntry> drawn_roster(Dice& dice) {
  const Tick reborn = dice.tick(1, kEnd), ours = dice.tick(0, kEnd);
  std::vector<RosterEntry> roster{entry_of({0, 7}, 0, ours), entry_of(kSelf, ours)};
  roster.push_back(entry_of({1, 5}, 0));
  roster.push_back(entry_of({2, 1}, reborn));
  roster.push_back(entry_of({2, 0xffffffffffffffff}, 0, dice.one_in(2) ? reborn : -1));
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
           life.speak(tick, dice.one_in(5) ? 1000 : dice.tick(1, kPeriod + 1))) {
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

class Foreseen : public ::testing::TestWithParam<bool> {
 protected:
  Mission mission_ = mission_of(GetParam());

  /// Looks at what is known in each of many histories.
  void in_every_history(const std::function<void(const Known&, Dice&)>& check) {
    for (std::uint64_t history = 0; history < kHistories; ++history) {
      SCOPED_TRACE("history " + std::to_string(history));
      Dice dice(1000 + history);
      check(drawn(history, mission_), dice);
    }
  }
};
INSTANTIATE_TEST_SUITE_P(Forecast, Foreseen, ::testing::Bool(), [](const auto& reckoning) {
  return std::string(reckoning.param ? "WithDeadReckoning" : "FromRowsAlone");
});

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

/// As many modes in six slabs, of which the second block begins within a row of the last.
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

TEST_P(Foreseen, IsAnAverageWhateverAnybodyClaims) {
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

// ---- which agents count ------------------------------------------------------------------------

/// A team of `agents` that has broadcast all at each of the ticks 0 … kEnd − 1, as its messages.
std::vector<Contribution> told_each_tick(int agents, const Mission& mission, Tick every = 1) {
  std::vector<Contribution> said;
  std::vector<Life> lives;
  for (AgentId id = 0; id < agents; ++id)
    lives.emplace_back(id == 0 ? kSelf : Author{id, 1}, mission);
  for (Tick tick = 0; tick < kEnd; ++tick) {
    for (Life& life : lives) {
      life.cover(tick);
      if (tick % every != 0) continue;
      for (const Contribution& block : life.speak(tick)) said.push_back(block);
    }
  }
  return said;
}

Known team_of(int agents, const Mission& mission, Tick every = 1) {
  Known known;
  known.heard = told_each_tick(agents, mission, every);
  for (AgentId id = 0; id < agents; ++id) {
    known.roster.push_back(entry_of(id == 0 ? kSelf : Author{id, 1}, 0));
  }
  known.tick = kEnd - 1;
  return known;
}

/// The same without anything to expect of agent 1; its coverage counts all the same.
Known without_hope_for_1(Known known) {
  known.roster.erase(known.roster.begin() + 1);
  return known;
}

TEST(ForecastCounts, NobodyWhoHasLeftOrIsYetToCome) {
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

TEST(ForecastCounts, OfOneNumberTheNewestLifeOnly) {
  const Mission mission = mission_of(false);
  const Known team = team_of(3, mission);
  // Whatever the order of the incarnations' numbers, which are random.
  for (const Incarnation newer : {Incarnation{0}, Incarnation{2}}) {
    Known known = team;
    const RosterEntry reborn = entry_of({1, newer}, 7);
    known.roster.insert(known.roster.begin() + (newer == 0 ? 1 : 2), reborn);
    EXPECT_EQ(foreseen(known, mission), foreseen(without_hope_for_1(team), mission)) << newer;
    // Until the newer one's first tick has come, the elder counts.
    known.roster[newer == 0 ? 1 : 2].active_from = kEnd;
    EXPECT_EQ(foreseen(known, mission), foreseen(team, mission)) << newer;
  }
}

TEST(ForecastCounts, NobodyWhoIsForgotten) {
  const Mission mission = mission_of(false);
  Known team = team_of(3, mission), known = team;
  known.forgotten = {{1, 1}};
  std::erase_if(team.heard, [](const Contribution& block) { return block.header.sender == 1; });
  EXPECT_EQ(foreseen(known, mission), foreseen(team, mission));
}

TEST(ForecastCounts, NoFormerLifeOfOurOwn) {
  const Mission mission = mission_of(false);
  Known known = team_of(3, mission);
  const Author former{0, 5};
  Life life(former, mission);
  for (Tick tick = 0; tick < 20; ++tick) life.cover(tick);
  for (const Contribution& block : life.speak(19)) known.heard.push_back(block);
  const Coefficients expected = foreseen(known, mission);
  // Also where the roster does not have its departure yet.
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

TEST(ForecastCounts, NobodyWhoseGainsAreImpossible) {
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
  const std::vector<Contribution> said_before = before.speak(kEnd - 2);
  last.sums.edit()[3] = said_before[0].sums[3] + kDt;
  EXPECT_LT((foreseen(known, mission) - by_the_formula(known, mission)).cwiseAbs().maxCoeff(),
            1e-12);
  EXPECT_NE(foreseen(known, mission), foreseen(without_hope_for_1(known), mission));
  last.sums.edit()[3] = said_before[0].sums[3] + 1.001 * kDt;
  EXPECT_EQ(foreseen(known, mission)[3], foreseen(without_hope_for_1(known), mission)[3]);
}

TEST(ForecastCounts, WhoHasBeenSilentForTooLongInTheTeamsNumberOnly) {
  const Mission mission = mission_of(false);
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
  // 2 goes on with the horizon of a team of three.
  Known alone = without_hope_for_1(later);
  Mission longer = mission;
  longer.law.anticipation *= std::sqrt(2.0 / 3);
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

TEST(ForecastCounts, ABlockThatSaysItIsFromTheFutureAsOneOfNow) {
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

// ---- what it does not depend on ----------------------------------------------------------------

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

TEST(DeadReckoning, RowsAreAsGoodAsIfTheyWereToldEachTickBitForBit) {
  const Mission mission = mission_of(true);
  const Known often = team_of(4, mission), seldom = team_of(4, mission, 10);
  Forecast by_words(mission, kSelf), by_places(mission, kSelf);
  CoverageTable told(mission.basis, kDt), reckoned(mission.basis, kDt);
  const auto hear = [](CoverageTable& table, const Known& team, Tick tick, bool all) {
    for (const Contribution& block : team.heard) {
      if (block.header.tick == tick && (all || block.header.sender == 0))
        table.merge(block, kManySteps);
    }
  };
  for (Tick tick = 0; tick < kEnd; ++tick) {
    hear(told, often, tick, true);
    hear(reckoned, often, tick, false);
    hear(reckoned, seldom, tick, true);
    see_all(by_words, 4, tick, mission);
    see_all(by_places, 4, tick, mission);
    Coefficients words(144), places(144);
    by_words.look_ahead(told, often.roster, tick, words);
    by_places.look_ahead(reckoned, seldom.roster, tick, places);
    ASSERT_EQ(words, places) << tick;
  }
}

TEST(DeadReckoning, DoesNotDependOnWhenPlacesAndBlocksComeNorOnWhenOneLooks) {
  const Mission mission = mission_of(true);
  const Known team = team_of(4, mission, 7);
  Known all = team;
  // Some are missed, so that what is reckoned is not what the next block says.
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

/// ĉ after the team has told all up to tick 20 and agent 1's vehicle was seen at 30 as `seen` says.
Coefficients with_a_place(const Mission& mission, const Known& told,
                          const std::function<void(Forecast&)>& seen) {
  Forecast forecast(mission, kSelf);
  seen(forecast);
  Coefficients coverage(144);
  forecast.look_ahead(table_of(told, mission), told.roster, 30, coverage);
  return coverage;
}

Known told_until(Tick last, const Mission& mission) {
  Known known = team_of(3, mission);
  std::erase_if(known.heard,
                [last](const Contribution& block) { return block.header.tick > last; });
  return known;
}

TEST(DeadReckoning, UsesNoPlacesThatAreNone) {
  const Mission mission = mission_of(true);
  const Known told = told_until(20, mission);
  const auto here = place(1, 30, mission);
  const Coefficients blind = with_a_place(mission, told, [](Forecast&) {});
  EXPECT_NE(with_a_place(mission, told, [&](Forecast& f) { f.see(1, 30, here); }), blind);
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
  for (const auto& [name, seen] : none) EXPECT_EQ(with_a_place(mission, told, seen), blind) << name;
  Mission by_rows = mission;
  by_rows.dead_reckoning = false;
  EXPECT_EQ(with_a_place(by_rows, told, [&](Forecast& f) { f.see(1, 30, here); }), blind)
      << "not wanted";
}

TEST(DeadReckoning, UsesNoPlaceTwiceNorOneOfAnEarlierTick) {
  const Mission mission = mission_of(true);
  const Known told = told_until(20, mission);
  const auto seen = [&](std::vector<std::pair<Tick, Tick>> said_and_true) {
    return with_a_place(mission, told, [&](Forecast& f) {
      for (const auto& [said, actual] : said_and_true) f.see(1, said, place(1, actual, mission));
    });
  };
  const Coefficients once = seen({{21, 21}, {25, 25}});
  EXPECT_EQ(seen({{21, 21}, {21, 3}, {25, 25}, {25, 4}}), once);
  EXPECT_EQ(seen({{21, 21}, {25, 25}, {23, 23}}), once);
}

TEST(DeadReckoning, UsesNoPlaceOfAFormerAuthorsTime) {
  // Agent 1 was restarted at tick 22: its vehicle's places before are its predecessor's.
  const Mission mission = mission_of(true);
  Known told = told_until(20, mission);
  told.roster[1].active_until = 22;
  told.roster.insert(told.roster.begin() + 2, entry_of({1, 5}, 22));
  Life reborn({1, 5}, mission);
  for (Tick tick = 22; tick < 24; ++tick) reborn.cover(tick);
  for (const Contribution& block : reborn.speak(23)) told.heard.push_back(block);
  const auto see_from = [&](Tick first) {
    return with_a_place(mission, told, [&](Forecast& forecast) {
      Coefficients looked(144);
      for (Tick tick = first; tick <= 30; ++tick) {
        forecast.see(1, tick, place(1, tick, mission));
        // While the former author was the newest, its row was reckoned on the same track.
        Known then = told_until(std::min<Tick>(tick, 20), mission);
        forecast.look_ahead(table_of(then, mission), tick < 22 ? then.roster : told.roster, tick,
                            looked);
      }
    });
  };
  EXPECT_EQ(see_from(0), see_from(24));
  told.tick = 30;
  for (Tick tick = 0; tick <= 30; ++tick) told.seen[1].push_back(tick);
  EXPECT_LT((see_from(0) - by_the_formula(told, mission)).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(DeadReckoning, LeavesWhatIsKnownAndPassedOnAsItWas) {
  const Mission mission = mission_of(true);
  const Known told = told_until(20, mission);
  const CoverageTable before = table_of(told, mission);
  CoverageTable table = before;
  Forecast forecast(mission, kSelf);
  Coefficients foreseen(144), known(144), known_before(144);
  before.average(known_before);
  for (Tick tick = 21; tick < kEnd; ++tick) {
    see_all(forecast, 3, tick, mission);
    forecast.look_ahead(table, told.roster, tick, foreseen);
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
