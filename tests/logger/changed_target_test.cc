// SPDX-License-Identifier: BSD-3-Clause
// Each row of a record counts against the target of the row's own time.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "core/base/noise.h"
#include "logger/amendments_file.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "modes/provide.h"
#include "plan/amendment_list.h"
#include "tests/logger/drawn_target.h"
#include "tests/logger/record.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;

Eigen::Vector3d place_at(Tick tick, AgentId id) {
  return on_ground(2000 * uniform_pair(3, Purpose::kStart, static_cast<std::uint32_t>(id),
                                       static_cast<std::uint64_t>(tick)));
}
WorldState pair_at(Tick tick) { return world_state(tick, {place_at(tick, 0), place_at(tick, 1)}); }

/// φ² over the ticks [from, end) of `pair_at`: each counts against `target_at(tick)`.
template <class TargetAt>
double metric_over(const Mission& mission, Tick from, Tick end, const TargetAt& target_at) {
  Coefficients residual = Coefficients::Zero(mission.basis.mode_count());
  for (Tick tick = from; tick < end; ++tick)
    for (AgentId id = 0; id < 2; ++id)
      residual += basis_values(place_at(tick, id), mission.domain, mission.basis) - target_at(tick);
  residual /= 2 * static_cast<double>(end - from);
  return ergodic_metric(residual, Coefficients::Zero(residual.size()),
                        sobolev_weights(mission.basis, mission.domain));
}

MissionPart amended(std::int64_t revision, const Amendments& list) {
  MissionPart part = mission_part(revision, MissionState::kRunning, roster_of(2));
  part.amendments = encode_amendments(list);
  return part;
}

/// Three targets, from the ticks 20, 30 and 55 on, each named some ticks before.
class ChangedTarget : public testing::Test {
 protected:
  ChangedTarget() {
    for (std::uint64_t i = 0; i < 3; ++i) {
      TargetChange change = target_of(i);
      targets.push_back(change.target);
      name_target(lists.emplace_back(i > 0 ? lists.back() : Amendments()), kFrom[i],
                  std::move(change));
    }
  }
  const Coefficients& target_at(Tick tick) const {
    const Coefficients* target = &mission.target_coefficients;
    for (std::size_t i = 0; i < 3; ++i)
      if (tick >= kFrom[i]) target = &targets[i];
    return *target;
  }
  /// The ticks up to `end`; each list arrives `notice` ticks before its target holds.
  void fly(Record& record, Tick end, Tick notice = 5) const {
    for (Tick tick = 0; tick <= end; ++tick) {
      for (std::size_t i = 0; i < 3; ++i)
        if (tick == kFrom[i] - notice)
          give(record.recorder, amended(static_cast<std::int64_t>(i) + 1, lists[i]), at(0s));
      record.deliver(pair_at(tick));
    }
  }
  void expect_metrics(const std::vector<std::string>& rows) const {
    ASSERT_EQ(rows.size(), 11U);
    for (const std::string& row : rows) {
      const auto tick = static_cast<Tick>(number(row, 0));
      const double expected =
          metric_over(mission, 0, tick + 1, [this](Tick at) { return target_at(at); });
      EXPECT_NEAR(number(row, 2), expected, 1e-12 * expected) << tick;
    }
  }

  static constexpr std::array<Tick, 3> kFrom{20, 30, 55};
  Mission mission = small_mission(2);
  std::vector<Coefficients> targets;
  std::vector<Amendments> lists;  // after each change
};

TEST_F(ChangedTarget, EachMomentCountsAgainstTheTargetOfItsOwnTime) {
  Record record(mission);
  fly(record, 100);
  expect_metrics(record.metrics_rows());
}

TEST_F(ChangedTarget, NoRowIsWrittenBeforeTheMissionOfItsTickIsKnown) {
  Record record(mission);
  for (Tick tick = 0; tick <= 100; ++tick) {
    WorldState state = pair_at(tick);
    for (const Tick from : kFrom) state.roster_revision += tick >= from - 1 ? 1 : 0;
    record.deliver(state);
    EXPECT_LE(record.trajectory_rows().size(), 2U * (static_cast<std::size_t>(kFrom[0]) - 1));
  }
  for (std::size_t i = 0; i < 3; ++i)
    record.deliver(amended(static_cast<std::int64_t>(i) + 1, lists[i]));
  EXPECT_EQ(record.trajectory_rows().size(), 200U);
  expect_metrics(record.metrics_rows());
}

TEST_F(ChangedTarget, ARowWaitsNoLongerThanTheWorldForItsRecorder) {
  Record record(mission);
  for (Tick tick = 0; tick <= 10; ++tick) {
    WorldState state = pair_at(tick);
    state.roster_revision = 1;
    record.deliver(state, at(1s));
  }
  EXPECT_TRUE(record.trajectory_rows().empty());
  advance(record.recorder, at(1s) + seconds(mission.timing.lockstep_timeout_s / 4) - 1ms);
  EXPECT_TRUE(record.trajectory_rows().empty());
  advance(record.recorder, at(1s) + seconds(mission.timing.lockstep_timeout_s / 4));
  EXPECT_EQ(record.trajectory_rows().size(), 20U);
}

TEST_F(ChangedTarget, ARowThatWaitsIsWrittenAtTheEnd) {
  Record record(mission);
  for (Tick tick = 0; tick <= 10; ++tick) {
    WorldState state = pair_at(tick);
    state.roster_revision = 1;
    record.deliver(state);
  }
  record.recorder.stop("a signal stopped the logger");
  EXPECT_EQ(record.trajectory_rows().size(), 20U);
}

TEST_F(ChangedTarget, EachTargetHasThePhiSquaredOfItsOwnTime) {
  Record record(mission);
  fly(record, 100);
  const auto& facts = record.recorder.facts().targets;
  ASSERT_EQ(facts.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) {
    const Tick from = i > 0 ? kFrom[i - 1] : 0, until = i < 3 ? kFrom[i] : 100;
    EXPECT_EQ(facts[i].from, from);
    EXPECT_EQ(facts[i].until, until);
    const double expected =
        metric_over(mission, from, until, [this](Tick at) { return target_at(at); });
    EXPECT_NEAR(facts[i].ergodic_metric, expected, 1e-9 * expected) << i;
  }
  const auto summary = summarize(record.recorder, {});
  ASSERT_EQ(summary["targets"].size(), 4U);
  EXPECT_TRUE(summary["targets"][0]["amendment"].is_null());
  EXPECT_EQ(summary["targets"][3]["amendment"], 2);
  EXPECT_EQ(summary["targets"][3]["from_tick"], 55);
  EXPECT_EQ(summary["targets"][3]["until_tick"], 100);
  EXPECT_EQ(summary["targets"][3]["ergodic_metric"], facts[3].ergodic_metric);
  ASSERT_EQ(summary["amendments"].size(), 3U);
  EXPECT_EQ(summary["amendments"][2]["from_tick"], 55);
  EXPECT_FALSE(summary.contains("holds"));
}

TEST_F(ChangedTarget, WithoutAChangeTheSummaryNamesNone) {
  Record record(mission);
  for (Tick tick = 0; tick <= 100; ++tick) record.deliver(pair_at(tick));
  const auto summary = summarize(record.recorder, {});
  for (const char* key : {"targets", "amendments", "holds"})
    EXPECT_FALSE(summary.contains(key)) << key;
}

TEST_F(ChangedTarget, ATargetThatTurnsOutToBeVoidDoesNotHoldAnyLonger) {
  Record record(mission);
  Amendments lost = lists[0];
  name_target(lost, 40, target_of(9));
  for (Tick tick = 0; tick <= 100; ++tick) {
    if (tick == 10) give(record.recorder, amended(1, lists[0]), at(0s));
    if (tick == 35) give(record.recorder, amended(2, lost), at(0s));
    if (tick == 39) give(record.recorder, amended(3, lists[0]), at(0s));
    record.deliver(pair_at(tick));
  }
  const double expected = metric_over(mission, 0, 100, [this](Tick tick) {
    return tick < kFrom[0] ? mission.target_coefficients : targets[0];
  });
  EXPECT_NEAR(record.recorder.facts().ergodic_metric_last, expected, 1e-12 * expected);
  EXPECT_EQ(record.recorder.facts().targets.size(), 2U);
  EXPECT_EQ(summarize(record.recorder, {})["amendments"][1]["void"], true);
}

TEST_F(ChangedTarget, AResumedRecordCountsItsRowsAgainstTheirTargetsAgain) {
  Record lived(mission);
  fly(lived, 100);
  const TempFolder own;
  std::ofstream(own.path() / "trajectory.csv") << lived.trajectory.str();
  std::ofstream(own.path() / "metrics.csv") << std::string(kMetricsHeader) << '\n';
  std::ofstream(own.path() / "amendments.json")
      << amendments_text(lived.recorder.amendments(), 0.1);
  std::ostringstream trajectory, metrics;
  announce(mission);
  Recorder resumed(kRun, kLoggerLife, trajectory, metrics);
  resumed.resume(read_run(own.path(), mission).value());
  give(resumed, amended(1, lists[2]), at(0s));
  EXPECT_EQ(rows_of(metrics.str()), lived.metrics_rows());
  const auto &again = resumed.facts().targets, &before = lived.recorder.facts().targets;
  ASSERT_EQ(again.size(), before.size());
  for (std::size_t i = 0; i < again.size(); ++i)
    EXPECT_EQ(again[i].ergodic_metric, before[i].ergodic_metric) << i;
}

TEST(ChangedTargetInAFreeDomain, CountsInBothBases) {
  Mission mission = small_mission(2);
  mission.cosine_target = mission.target_coefficients;
  mission.basis.free_domain = true;
  mission.basis.table_hash = table_of(mission).value()->hash;
  Record record(mission);
  Amendments list;
  const TargetChange change = target_of(5, true);
  name_target(list, 40, change);
  give(record.recorder, amended(1, list), at(0s));
  for (Tick tick = 0; tick <= 100; ++tick) record.deliver(pair_at(tick));
  const Mission cosines = in_cosines(mission);
  const auto target_at = [&](Tick tick) {
    return tick < 40 ? cosines.target_coefficients : change.cosine;
  };
  const RunFacts& facts = record.recorder.facts();
  const double all = metric_over(cosines, 0, 100, target_at),
               since = metric_over(cosines, 40, 100, target_at);
  EXPECT_NEAR(facts.cosine_metric_last, all, 1e-12 * all);
  ASSERT_EQ(facts.targets.size(), 2U);
  EXPECT_NEAR(facts.targets[1].cosine_metric, since, 1e-9 * since);
  Mission with_table = mission;
  ASSERT_FALSE(provide_table(with_table));
  const auto free_target_at = [&](Tick tick) {
    return tick < 40 ? mission.target_coefficients : change.target;
  };
  const double in_modes = metric_over(with_table, 0, 100, free_target_at);
  EXPECT_NEAR(facts.ergodic_metric_last, in_modes, 1e-12 * in_modes);
}

}  // namespace
}  // namespace ergocast
