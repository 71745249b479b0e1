// SPDX-License-Identifier: BSD-3-Clause
// A new target shifts samples, and nothing else: what a row then adds up to, and how forecasts
// correct gains from before the change.
#include "core/law/target_shift.h"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "core/law/coverage_table.h"
#include "core/law/forecast.h"
#include "tests/support/team.h"

namespace ergocast {
namespace {

using namespace test;

constexpr Author kOwn{0, 1}, kMate{1, 1};

/// A mission whose agents answer to forecasts.
Mission mission_with(bool dead_reckoning) {
  Mission mission = small_mission(2);
  mission.law.anticipation = 1;
  mission.dead_reckoning = dead_reckoning;
  mission.timing.broadcast_period_ticks = 5;
  return mission;
}

/// All is at one place.
TargetChange target_at_place(const Mission& mission, const Eigen::Vector3d& x_m) {
  TargetChange change;
  change.target = basis_values(x_m, mission.domain, mission.basis);
  return change;
}

Amendments changed_at(const Mission& mission, std::vector<std::pair<Tick, Eigen::Vector3d>> all) {
  Amendments list;
  for (const auto& [tick, x_m] : all) name_target(list, tick, target_at_place(mission, x_m));
  return list;
}

Eigen::Vector3d place(Tick tick) { return {100.0 + 31 * static_cast<double>(tick), 700, 0}; }

/// Adds a tick at place() to the row of `author`, as an agent does.
void cover(CoverageTable& table, const Author& author, const Mission& mission,
           const TargetShift& shift, Tick tick) {
  table.set_now(tick);
  table.add_sample(author, BasisAt(place(tick), mission.domain, mission.basis));
  const auto* const change = shift.of_sample(tick);
  if (change != nullptr) table.shift_sample(author, change->by_slot.data());
}

TEST(TargetShift, HoldsFromItsTickOnAmongThoseThatCount) {
  const Mission mission = small_mission(1);
  Amendments list = changed_at(mission, {{20, {1, 1, 0}}, {30, {9, 9, 0}}});
  list.holds = {{5, 15}};
  TargetShift shift(mission);
  EXPECT_FALSE(shift.any_of_samples());
  shift.note(list);
  EXPECT_EQ(shift.of_sample(9), nullptr);
  ASSERT_NE(shift.of_sample(10), nullptr);
  EXPECT_EQ(shift.of_sample(19)->number, 0);
  EXPECT_EQ(shift.of_sample(20)->number, 1);
  EXPECT_EQ(shift.of_sample(20)->by_slot[0], 0) << "each sample still counts a step";
  EXPECT_EQ(shift.of_sample(20)->by_slot[3],
            list.targets[1].target[3] - mission.target_coefficients[3]);
}

TEST(TargetShift, IsOfTheCoverageWhereTheHistoryIsKept) {
  Mission mission = small_mission(1);
  const Amendments list = changed_at(mission, {{20, {1, 1, 0}}});
  TargetShift by_time(mission);
  mission.law.history = TargetHistory::kKeep;
  TargetShift kept(mission);
  by_time.note(list);
  kept.note(list);
  EXPECT_EQ(by_time.of_coverage(20), nullptr);
  EXPECT_FALSE(kept.any_of_samples());
  EXPECT_EQ(kept.of_sample(20), nullptr);
  EXPECT_EQ(kept.of_coverage(19), nullptr);
  ASSERT_NE(kept.of_coverage(20), nullptr);
  const Coefficients change = list.targets[0].target - mission.target_coefficients;
  EXPECT_EQ(kept.of_coverage(20)->by_mode, change);
}

TEST(TargetShift, ForgetsWhatANewerListReplaces) {
  const Mission mission = small_mission(1);
  const Amendments first = changed_at(mission, {{10, {1, 1, 0}}, {20, {2, 2, 0}}});
  TargetShift shift(mission);
  shift.note(first);
  Amendments second = first;  // of a coordinator that knows only the first target
  second.targets.erase(second.targets.begin());
  second.targets[0].from = 15;
  shift.note(second);
  ASSERT_EQ(shift.changes().size(), 2U);
  EXPECT_EQ(shift.of_sample(14)->from, 10) << "it held in those ticks";
  EXPECT_EQ(shift.of_sample(15)->from, 15);
  shift.note({});  // of a coordinator that knows none
  EXPECT_FALSE(shift.any_of_samples());
}

TEST(ShiftedRow, IsTheSumOfWhatEachMomentAddedAgainstItsTarget) {
  const Mission mission = small_mission(1);
  const Amendments list = changed_at(mission, {{4, {300, 900, 0}}, {7, {50, 1700, 0}}});
  TargetShift shift(mission);
  shift.note(list);
  CoverageTable table(mission.basis, mission.timing.dt_s);
  table.allow_shifts();
  Coefficients expected = Coefficients::Zero(20);
  for (Tick tick = 0; tick < 10; ++tick) {
    cover(table, kOwn, mission, shift, tick);
    const TargetChange* const change = target_at(list.targets, tick);
    const Coefficients& target = change ? change->target : mission.target_coefficients;
    expected += basis_values(place(tick), mission.domain, mission.basis) - target +
                mission.target_coefficients;
  }
  Coefficients coverage = Coefficients::Zero(20);
  table.average(coverage);
  EXPECT_LT((coverage - expected / 10).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_DOUBLE_EQ(coverage[0], 1);
}

TEST(ShiftedRow, OfAnUnknownTargetIsNotTakenAsANormalOne) {
  const Mission mission = small_mission(1);
  CoverageTable author(mission.basis, mission.timing.dt_s), receiver = author;
  author.allow_shifts();
  TargetShift shift(mission);
  shift.note(changed_at(mission, {{0, {1999, 1999, 0}}}));
  cover(author, kOwn, mission, shift, 0);
  Contribution block = author.block(kOwn, 0);
  EXPECT_GT(block.sums.largest(), 1.5 * block.elapsed_s);
  EXPECT_EQ(receiver.merge(block, 10), Merge::kRefusedShift);
  receiver.allow_shifts();
  EXPECT_EQ(receiver.merge(block, 10), Merge::kNewer);
  block.sums.edit()[5] = 3.1 * block.elapsed_s;
  block.steps = 2;
  EXPECT_EQ(receiver.merge(block, 10), Merge::kRefusedRange);
}

TEST(ShiftedRow, HalvesShiftsWithTheirSamples) {
  Mission mission = small_mission(1);
  mission.law.memory_half_life_s = 3 * mission.timing.dt_s;
  const Amendments list = changed_at(mission, {{4, {300, 900, 0}}, {7, {50, 1700, 0}}});
  TargetShift shift(mission);
  shift.note(list);
  CoverageTable author(mission.basis, mission.timing.dt_s);
  author.set_half_life(HalfLife(mission));
  CoverageTable receiver = author;
  author.allow_shifts(), receiver.allow_shifts();
  Coefficients sums = Coefficients::Zero(20);
  double steps = 0;
  for (Tick tick = 0; tick < 11; ++tick) {
    cover(author, kOwn, mission, shift, tick);
    const TargetChange* const change = target_at(list.targets, tick);
    const Coefficients& target = change ? change->target : mission.target_coefficients;
    const double weight = std::pow(0.5, static_cast<double>(10 / 3 - tick / 3));
    sums += weight * (basis_values(place(tick), mission.domain, mission.basis) - target +
                      mission.target_coefficients);
    steps += weight;
  }
  Contribution block = author.block(kOwn, 0);
  block.header.tick = 10;
  EXPECT_EQ(receiver.merge(block, 100), Merge::kNewer);
  for (CoverageTable* const table : {&author, &receiver}) {
    Coefficients coverage = Coefficients::Zero(20);
    for (const Tick now : {10, 12, 40}) {
      table->set_now(now);
      table->average(coverage);
      EXPECT_LT((coverage - sums / steps).cwiseAbs().maxCoeff(), 1e-14) << now;
    }
  }
}

struct Teammate {
  const char* name;
  bool seen;
  int half_life_ticks = 0;
};
class ShiftedForecast : public ::testing::TestWithParam<Teammate> {};

/// ĉ a tick after a change is that of a team whose target never changed, but for the shift of each
/// tick: known rows have the shifts of their ticks, and the teammate goes on with the present one.
TEST_P(ShiftedForecast, GoesOnWithThePresentShift) {
  const bool seen = GetParam().seen;
  const int half_life = GetParam().half_life_ticks;
  Mission mission = mission_with(seen);
  mission.law.memory_half_life_s = half_life * mission.timing.dt_s;
  for (const Tick change : {3, 6, 8, 9, 10}) {
    TargetShift none(mission), shift(mission);
    shift.note(changed_at(mission, {{2, {1500, 300, 0}}, {change, {300, 1500, 0}}}));
    const auto foreseen = [&](const TargetShift& by) {
      CoverageTable mate(mission.basis, mission.timing.dt_s);
      mate.set_half_life(HalfLife(mission));
      CoverageTable own = mate;
      mate.allow_shifts(), own.allow_shifts();
      Forecast forecast(mission, kOwn);
      for (Tick tick = 0; tick <= 10; ++tick) {
        cover(mate, kMate, mission, by, tick);
        cover(own, kOwn, mission, by, tick);
        forecast.see(kMate.agent, tick, place(tick));
        if (tick != 4 && tick != 8) continue;
        Contribution block = mate.block(kMate, 0);
        block.header.tick = tick;
        block.next_broadcast_tick = tick + 4;
        EXPECT_EQ(own.merge(block, 100), Merge::kNewer);
      }
      Coefficients c = Coefficients::Zero(20);
      forecast.note_shift(by);
      forecast.look_ahead(own, {{kOwn, 0, -1}, {kMate, 0, -1}}, 10, c);
      return c;
    };
    const Coefficients plain = foreseen(none), shifted = foreseen(shift);
    // How much time ĉ gives each tick: the own 11 steps, the teammate's known ones, and w.
    const double dt_s = mission.timing.dt_s;
    Coefficients lacks_s = Coefficients::Zero(20), present = Coefficients::Zero(20);
    const auto shift_at = [&](Tick tick) {
      Coefficients by = Coefficients::Zero(20);
      if (const auto* one = shift.of_sample(tick))
        by = Eigen::Map<const Coefficients>(one->by_slot.data(), 20);
      return by;
    };
    const Tick known = seen ? 10 : 8;
    double known_s = 0;
    for (const Tick last : {Tick{10}, known}) {
      for (Tick tick = 0; tick <= last; ++tick) {
        const Tick halvings = half_life > 0 ? 10 / half_life - tick / half_life : 0;
        const double step_s = dt_s * std::pow(0.5, static_cast<double>(halvings));
        known_s += step_s;
        lacks_s += step_s * shift_at(tick);
      }
    }
    LookAhead look_ahead(mission);
    const double weight_s =
        look_ahead.weight_s(look_ahead.horizon_s(2, 10), seen ? 1 : 4, 10 - known, 4);
    const Coefficients expected =
        plain - (lacks_s + weight_s * shift_at(10)) / (known_s + weight_s);
    EXPECT_LT((shifted - expected).cwiseAbs().maxCoeff(), 1e-13) << change;
  }
}

INSTANTIATE_TEST_SUITE_P(Teammate, ShiftedForecast,
                         ::testing::Values(Teammate{"Seen", true}, Teammate{"Received", false},
                                           Teammate{"SeenByOneThatForgets", true, 3},
                                           Teammate{"ReceivedByOneThatForgets", false, 3},
                                           Teammate{"ReceivedAtAHalving", false, 5}),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace ergocast
