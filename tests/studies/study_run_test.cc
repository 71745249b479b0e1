// SPDX-License-Identifier: BSD-3-Clause
// What a study records of one mission.
#include "studies/study_run.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "plan/plan.h"
#include "scenario/scenario.h"
#include "studies/study_measure.h"

namespace ergocast::studies {
namespace {

Scenario shipped(const std::string& name, double duration_s) {
  Overrides overrides;
  overrides.duration_s = duration_s;
  const auto file = std::filesystem::path(ERGOCAST_SCENARIO_DIR) / (name + ".textproto");
  return Scenario::load(file, overrides).value();
}

/// 100 m × 200 m, ten ticks of 1 s; one agent on the midline x = 50, one in general position.
Mission hand_made() {
  Mission mission;
  mission.seed = 9;
  mission.domain = {{0, 0, 0}, {100, 200, 0}};
  mission.timing.dt_s = 1;
  mission.timing.tick_count = 11;
  mission.law.contraction_center_m = {50, 100, 0};
  mission.target_coefficients = Coefficients::Ones(1);
  mission.starts_m = {{50, 30, 0}, {31, 17, 0}};
  return mission;
}

TEST(StudyMeasure, MeasuresOffsetsEdgesAndSpeeds) {
  const Mission mission = hand_made();
  StudyMeasure measure(mission);
  measure.position(0, 0, {50, 30, 0});       // 70 m off the centre
  measure.position(1, 0, {50, 100, 0});      // on it
  measure.position(0, 1, {0.0999, 100, 0});  // nearer to the left edge than 0.1 m
  measure.position(1, 1, {50, 199.89, 0});   // 0.11 m from the upper edge
  measure.command({3, 4, 0});
  measure.command({0, 0, 0});
  measure.command({0, 1, 0});
  const StudyFigures figures = measure.figures();
  EXPECT_EQ(figures.seed, 9U);
  EXPECT_EQ(figures.agents, 2);
  const double left2 = 49.9001 * 49.9001, upper2 = 99.89 * 99.89;
  EXPECT_NEAR(figures.offset2_mean_m2, (4900 + left2 + upper2) / 4, 1e-9);
  EXPECT_NEAR(figures.offset2_max_m2, upper2, 1e-9);
  EXPECT_EQ(figures.edge_share, 0.25);
  EXPECT_EQ(figures.speed_mean_mps, 2);
  EXPECT_FALSE(figures.complete);
}

TEST(StudyMeasure, EscapeIsTheFirstTimeFartherThanOnePercentOfTheShorterSide) {
  const Mission mission = hand_made();
  StudyMeasure measure(mission);
  const double x_m[] = {50, 51, 51.0001, 50, 60};
  for (Tick tick = 0; tick < 5; ++tick) {
    measure.position(0, tick, {x_m[tick], 30 + 10.0 * static_cast<double>(tick), 0});
    measure.position(1, tick, {x_m[tick], 17, 0});
  }
  EXPECT_EQ(measure.figures().escape_time_s[0], 2);
  EXPECT_TRUE(std::isnan(measure.figures().escape_time_s[1])) << "its start lies on no manifold";
  EXPECT_TRUE(std::isnan(measure.figures().escape_time_s[2])) << "there is no such agent";
}

TEST(StudyMeasure, AnAgentThatStaysOnTheManifoldHasNotEscaped) {
  const Mission mission = hand_made();
  StudyMeasure measure(mission);
  measure.position(0, 0, {50, 30, 0});
  measure.position(0, 1, {50.9, 180, 0});
  EXPECT_EQ(measure.figures().escape_time_s[0], std::numeric_limits<double>::infinity());
}

TEST(StudyMeasure, NotesTheMetricAtTheFirstTickOfEachStepOfTheLadderAndAtTheEnd) {
  Mission mission = hand_made();
  mission.timing.dt_s = 0.3;
  mission.timing.tick_count = 51;  // up to 15 s
  StudyMeasure measure(mission);
  for (Tick tick = 0; tick < 51; ++tick) {
    measure.position(0, tick, {50, 30, 0});
    if (measure.wants_metric(tick)) measure.metric(tick, 100 + static_cast<double>(tick));
  }
  const StudyFigures figures = measure.figures();
  EXPECT_EQ(figures.metric_at[0], 104);   // 1.2 s for 1 s
  EXPECT_EQ(figures.metric_at[1], 105);   // 1.5 s for 1.25 s
  EXPECT_EQ(figures.metric_at[3], 107);   // 2.1 s for 2 s
  EXPECT_EQ(figures.metric_at[7], 117);   // 5.1 s for 5 s
  EXPECT_EQ(figures.metric_at[10], 134);  // 10.2 s for 10 s
  EXPECT_EQ(figures.metric_at[11], 142);  // 12.6 s for 12.5 s
  EXPECT_TRUE(std::isnan(figures.metric_at[12]));
  EXPECT_EQ(figures.metric, 150);
  EXPECT_TRUE(figures.complete);
}

TEST(StudyMeasure, ATimeThatTheStepDividesIsThatTick) {
  Mission mission = hand_made();
  mission.timing.dt_s = 0.1;
  mission.timing.tick_count = 10001;
  StudyMeasure measure(mission);
  measure.position(0, 0, {50, 30, 0});
  for (Tick tick = 0; tick < 10001; ++tick) {
    if (measure.wants_metric(tick)) measure.metric(tick, static_cast<double>(tick));
  }
  const StudyFigures figures = measure.figures();
  for (std::size_t i = 0; i <= 30; ++i) {  // up to 1000 s; between 1 and 2 s lie odd times
    EXPECT_EQ(figures.metric_at[i], std::ceil(std::round(kLadder_s[i] * 100) / 10)) << i;
  }
}

TEST(StudyMeasure, SlopeIsThePowerOfTheLastDecade) {
  Mission mission = hand_made();
  mission.timing.tick_count = 1001;
  StudyMeasure measure(mission);
  int asked = 0;
  for (Tick tick = 0; tick < 1001; ++tick) {
    measure.position(0, tick, {50, 30, 0});
    if (!measure.wants_metric(tick)) continue;
    const auto t = static_cast<double>(tick);
    measure.metric(tick, t < 100 ? 1 : std::pow(t / 100, -1.5));
    ++asked;
  }
  EXPECT_NEAR(measure.figures().slope, -1.5, 1e-12);
  EXPECT_LT(asked, 50) << "a metric costs as much as a step";
}

/// Equal bit for bit, nan included.
void expect_same(const StudyFigures& a, const StudyFigures& b) {
  EXPECT_EQ(a.seed, b.seed);
  EXPECT_EQ(a.agents, b.agents);
  EXPECT_EQ(a.complete, b.complete);
  EXPECT_EQ(std::memcmp(a.metric_at.data(), b.metric_at.data(), sizeof a.metric_at), 0);
  EXPECT_EQ(a.metric, b.metric);
  EXPECT_EQ(a.slope, b.slope);
  EXPECT_EQ(std::memcmp(a.escape_time_s.data(), b.escape_time_s.data(), sizeof a.escape_time_s), 0);
  EXPECT_EQ(a.offset2_mean_m2, b.offset2_mean_m2);
  EXPECT_EQ(a.offset2_max_m2, b.offset2_max_m2);
  EXPECT_EQ(a.edge_share, b.edge_share);
  EXPECT_EQ(a.speed_mean_mps, b.speed_mean_mps);
  EXPECT_EQ(a.messages, b.messages);
}

TEST(StudyRun, IsTheSameWithAndWithoutMessages) {
  for (const char* name : {"quadrimodal_corners", "paper_fig1b", "paper_fig2a"}) {
    SCOPED_TRACE(name);
    const Scenario scenario = shipped(name, 60);
    const StudyFigures figures = run_without_messages(scenario.mission());
    EXPECT_TRUE(figures.complete);
    EXPECT_GT(figures.messages, 0);
    expect_same(figures, run_with_messages(encode_plan(scenario.mission())));
    expect_same(figures, run_study_mission(encode_plan(scenario.mission())));
  }
}

TEST(StudyRun, IsTheSameWithMoreAgentsThanOneWorldStateHolds) {
  Overrides overrides;
  overrides.duration_s = 5;
  overrides.agents = 20;
  const auto file = std::filesystem::path(ERGOCAST_SCENARIO_DIR) / "quadrimodal_corners.textproto";
  const auto scenario = Scenario::load(file, overrides).value();
  expect_same(run_without_messages(scenario.mission()),
              run_with_messages(encode_plan(scenario.mission())));
}

TEST(StudyRun, RunsRealTimeMissionsInVirtualTime) {
  const StudyFigures figures = run_study_mission(encode_plan(shipped("faulty_team", 20).mission()));
  EXPECT_TRUE(figures.complete);
  EXPECT_GT(figures.messages, 0);
  EXPECT_GT(figures.metric_at[0], figures.metric);
}

TEST(StudyRun, DiffersBySeed) {
  const Scenario scenario = shipped("quadrimodal_corners", 20);
  EXPECT_NE(run_study_mission(encode_plan(scenario.with_seed(1).mission())).metric,
            run_study_mission(encode_plan(scenario.with_seed(2).mission())).metric);
}

}  // namespace
}  // namespace ergocast::studies
