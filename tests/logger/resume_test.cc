// SPDX-License-Identifier: BSD-3-Clause
// A logger that was killed and continues writes the record that it would have written without the
// kill. Nothing is written twice or changed.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "logger/run_record.h"
#include "modes/provide.h"
#include "tests/logger/resumed_record.h"

namespace ergocast {
namespace {

using namespace test;

/// The first columns, which do not depend on the arrival of statuses.
std::vector<std::string> observed(const std::vector<std::string>& metrics_rows) {
  std::vector<std::string> rows;
  for (const std::string& row : metrics_rows) {
    const auto fields = columns(row);
    rows.push_back(fields[0] + ',' + fields[1] + ',' + fields[2] + ',' + fields[3]);
  }
  return rows;
}

std::vector<std::string> joined(std::vector<std::string> first,
                                const std::vector<std::string>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

TEST_F(Resume, WhereverTheFilesAreCutTheRecordIsThatOfARecorderThatWasNotStopped) {
  Mission mission = small_mission(3);
  mission.separation.distance_m = 1;
  mission.speed_limit_mps = 20;
  Record lived(mission), killed(mission);
  for (Tick tick = 0; tick <= 100; ++tick) lived.deliver(team_at(tick));
  for (Tick tick = 0; tick <= 60; ++tick) killed.deliver(team_at(tick));
  ASSERT_EQ(lived.trajectory_rows().size(), 300u);
  EXPECT_LT(lived.recorder.facts().nearest_m, 2) << "at tick 7";
  const std::string trajectory = killed.trajectory.str(), metrics = killed.metrics.str();
  for (std::size_t cut = 0; cut < trajectory.size(); cut += 71) {
    // One table may be longer than the other.
    const std::string rows = trajectory.substr(0, cut);
    const std::string values = metrics.substr(0, cut * 13 % metrics.size());
    Record resumed(mission, past(rows, values));
    for (Tick tick = 0; tick <= 100; ++tick) resumed.deliver(team_at(tick));
    ASSERT_EQ(joined(rows_of(rows), resumed.trajectory_rows()), lived.trajectory_rows()) << cut;
    ASSERT_EQ(observed(joined(rows_of(values), resumed.metrics_rows())),
              observed(lived.metrics_rows()))
        << cut;
    const RunFacts &facts = resumed.recorder.facts(), &all = lived.recorder.facts();
    EXPECT_EQ(facts.ticks, 100);
    EXPECT_EQ(facts.gaps, 0);
    EXPECT_EQ(facts.t_s, all.t_s);
    EXPECT_EQ(facts.ergodic_metric, all.ergodic_metric);
    EXPECT_EQ(facts.ergodic_metric_first, all.ergodic_metric_first);
    EXPECT_EQ(facts.ergodic_metric_last, all.ergodic_metric_last);
    EXPECT_EQ(facts.nearest_m, all.nearest_m);
  }
}

/// Three reports of an object confirm it, two of them recorded by the former process.
TEST_F(Resume, ReportsOfTheFormerProcessCount) {
  Mission mission = small_mission(1);
  mission.objects.count = 1;
  mission.sensor.false_alarms_per_s = 0.01;
  const auto seen_at = [](Tick tick) {
    WorldState state = state_of(tick);
    const bool sees = tick == 3 || tick == 5 || tick == 12;
    state.vehicles[0].detected = sees ? 1 : 0;
    state.vehicles[0].reported_cell = sees ? 7 : kNoCell;
    return state;
  };
  Record whole(mission), first(mission);
  for (Tick tick = 0; tick < 20; ++tick) {
    whole.deliver(seen_at(tick));
    if (tick < 10) first.deliver(seen_at(tick));
  }
  EXPECT_TRUE(whole.trajectory_rows()[3].ends_with(",1,7")) << whole.trajectory_rows()[3];
  EXPECT_TRUE(whole.trajectory_rows()[4].ends_with(",0,-1")) << whole.trajectory_rows()[4];
  Record second(mission, past(first.trajectory.str(), first.metrics.str()));
  for (Tick tick = 9; tick < 20; ++tick) second.deliver(seen_at(tick));
  const std::vector<Find>& finds = whole.recorder.facts().finds.list();
  const std::vector<Find>& resumed = second.recorder.facts().finds.list();
  ASSERT_EQ(finds.size(), 1u);
  EXPECT_EQ(finds[0].tick, 12);
  ASSERT_EQ(resumed.size(), 1u);
  EXPECT_EQ(resumed[0].tick, 12);
  EXPECT_EQ(second.recorder.facts().wrong_confirmations, 0);
}

/// Object 5 does not exist.
TEST_F(Resume, FindsOfTheFormerProcessCount) {
  Mission mission = small_mission(1);
  mission.objects.count = 4;
  const auto found_at = [](Tick tick, ObjectSet detected) {
    WorldState state = state_of(tick);
    state.vehicles[0].detected = detected;
    return state;
  };
  Record whole(mission), first(mission);
  for (Tick tick = 0; tick < 20; ++tick) {
    const ObjectSet detected = tick == 3 ? 0b100100 : tick == 12 ? 0b000111 : 0;
    whole.deliver(found_at(tick, detected));
    if (tick < 10) first.deliver(found_at(tick, detected));
  }
  const std::vector<Find>& finds = whole.recorder.facts().finds.list();
  ASSERT_EQ(finds.size(), 3u);
  EXPECT_EQ(finds[0].object, 2);
  EXPECT_EQ(finds[0].tick, 3);
  EXPECT_EQ(finds[0].x_m, state_of(3).vehicles[0].position_m);
  EXPECT_NEAR(finds[0].t_s, 0.3, 1e-12);
  EXPECT_EQ(finds[2].object, 1);
  EXPECT_EQ(finds[2].tick, 12);
  EXPECT_TRUE(whole.trajectory_rows()[3].ends_with(",4")) << whole.trajectory_rows()[3];

  Record second(mission, past(first.trajectory.str(), first.metrics.str()));
  for (Tick tick = 9; tick < 20; ++tick) second.deliver(found_at(tick, tick == 12 ? 0b111 : 0));
  const std::vector<Find>& again = second.recorder.facts().finds.list();
  ASSERT_EQ(again.size(), 3u);
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_EQ(again[i].object, finds[i].object);
    EXPECT_EQ(again[i].tick, finds[i].tick);
  }
}

TEST_F(Resume, ACompleteRecordIsDone) {
  Record former(small_mission(1));
  for (Tick tick = 0; tick <= 100; ++tick) former.deliver(state_of(tick));
  Record resumed(small_mission(1), past(former.trajectory.str(), former.metrics.str()));
  EXPECT_EQ(acks(advance(resumed.recorder, at(0s))), (std::vector<Tick>{99}));
  advance(resumed.recorder, at(1s));
  EXPECT_TRUE(resumed.recorder.finished());
  EXPECT_STREQ(resumed.recorder.result(), "done");
  EXPECT_EQ(resumed.recorder.facts().ticks, 100);
  EXPECT_TRUE(resumed.trajectory_rows().empty());
}

TEST_F(Resume, WithoutARecordOneIsBegun) {
  Record resumed(small_mission(1), RunData{});
  for (Tick tick = 0; tick <= 20; ++tick) resumed.deliver(state_of(tick));
  EXPECT_EQ(resumed.trajectory_rows().size(), 20u);
  EXPECT_EQ(resumed.recorder.facts().gaps, 0);
}

TEST_F(Resume, GapsOfTheFormerProcessStayCounted) {
  Record former(realtime_mission());
  for (Tick tick = 0; tick <= 40; ++tick) {
    if (tick != 10) former.deliver(state_of(tick));
  }
  Record resumed(realtime_mission(), past(former.trajectory.str(), former.metrics.str()));
  for (Tick tick = 40; tick <= 60; ++tick) resumed.deliver(state_of(tick));
  EXPECT_EQ(resumed.recorder.facts().gaps, 2);
  EXPECT_EQ(resumed.recorder.facts().ticks, 58);
}

TEST_F(Resume, CountsOfMessagesDoNotFallBack) {
  Record former(small_mission(1));
  AgentStatus status = status_of(0, 1, 0);
  status.contributions_received = 700;
  status.contributions_lost = 7;
  former.deliver(status);
  for (Tick tick = 0; tick <= 5; ++tick) former.deliver(state_of(tick));
  Record resumed(small_mission(1), past(former.trajectory.str(), former.metrics.str()));
  for (Tick tick = 5; tick <= 15; ++tick) resumed.deliver(state_of(tick));
  ASSERT_EQ(resumed.metrics_rows().size(), 1u);
  EXPECT_EQ(columns(resumed.metrics_rows()[0])[6], "700");
  EXPECT_EQ(columns(resumed.metrics_rows()[0])[7], "7");
}

TEST_F(Resume, WhatIsAcknowledgedIsInTheFile) {
  auto record = RunRecord::create(dir).value();
  const Mission mission = small_mission(1);
  announce(mission);
  Recorder recorder(kRun, kLoggerLife, record->trajectory(), record->metrics());
  give(recorder, mission_part(0, MissionState::kRunning, roster_of(1)), at(0s));
  int seen = 0;
  for (Tick tick = 0; tick <= 60; ++tick) {
    give(recorder, state_of(tick), at(0s));
    for (const Tick ack : acks(advance(recorder, at(0s)))) {
      EXPECT_EQ(rows_of(read("trajectory.csv")).size(), static_cast<std::size_t>(ack + 1));
      EXPECT_EQ(rows_of(read("metrics.csv")).size(), static_cast<std::size_t>(ack + 10) / 10);
      ++seen;
    }
  }
  EXPECT_EQ(seen, 4);
}

// No table of the record has this metric.
TEST_F(Resume, KnowsTheMetricInCosinesWithoutARowMore) {
  Mission mission = small_mission(1);
  mission.cosine_target = mission.target_coefficients;
  mission.basis.free_domain = true;
  mission.basis.table_hash = table_of(mission).value()->hash;
  Record lived(mission);
  EXPECT_TRUE(std::isnan(lived.recorder.facts().cosine_metric_last)) << "no agent has moved yet";
  for (Tick tick = 0; tick <= 100; ++tick) lived.deliver(state_of(tick));
  const double metric = lived.recorder.facts().cosine_metric_last;
  EXPECT_GT(metric, 0);
  Record resumed(mission, past(lived.trajectory.str(), lived.metrics.str()));
  EXPECT_EQ(resumed.recorder.facts().cosine_metric_last, metric);
}

}  // namespace
}  // namespace ergocast
