// SPDX-License-Identifier: BSD-3-Clause
// Times a study on one core: missions without messages, and their recorded numbers.
//
// An iteration is one mission. Two threads represent the two worker processes of a study; they
// share no data. The lower bound is the same number of plain control steps, each of a single agent.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "lab/ideal_team.h"
#include "scenario/scenario.h"
#include "studies/study_run.h"
#include "tests/bench/step_floor.h"

namespace ergocast::bench {
namespace {

Mission mission_of(int agents, bool looks_ahead) {
  Overrides overrides;
  overrides.duration_s = 600;
  overrides.agents = agents;
  const std::string file = std::string(ERGOCAST_SCENARIO_DIR) + "/quadrimodal_corners.textproto";
  Mission mission = Scenario::load(file, overrides).value().mission();
  if (!looks_ahead) mission.law.anticipation = 0;
  return mission;
}

void report(const Mission& mission, benchmark::State& state) {
  const std::int64_t agent_steps =
      mission.timing.tick_count * static_cast<std::int64_t>(mission.starts_m.size());
  state.counters["agent_steps_per_s"] = benchmark::Counter(
      static_cast<double>(agent_steps * static_cast<std::int64_t>(state.iterations())),
      benchmark::Counter::kIsRate);
}

void StudyRun(benchmark::State& state) {
  const Mission mission = mission_of(static_cast<int>(state.range(0)), state.range(1) != 0);
  for (auto _ : state) {
    const studies::StudyFigures figures = studies::run_without_messages(mission);
    benchmark::DoNotOptimize(figures.metric);
  }
  report(mission, state);
}

/// One tick of a team that shares all coverage.
void TeamStep(benchmark::State& state) {
  Mission mission = mission_of(static_cast<int>(state.range(0)), false);
  mission.law.anticipation = static_cast<double>(state.range(1));
  mission.basis.modes_x = mission.basis.modes_y = 20;
  mission.target_coefficients = Coefficients::Zero(mission.basis.mode_count());
  mission.target_coefficients[0] = 1;
  lab::IdealTeam team(std::move(mission));
  for (auto _ : state) team.step();
  state.counters["step_us"] =
      benchmark::Counter(1e-6 * static_cast<double>(state.iterations()),
                         benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
}

void StudyFloor(benchmark::State& state) {
  const Mission mission = mission_of(4, false);
  for (auto _ : state) {
    for (const Eigen::Vector3d& start_m : mission.starts_m) {
      StepFloor floor(mission, 1);
      std::vector<Eigen::Vector3d> x_m = {start_m};
      for (Tick tick = 0; tick < mission.timing.tick_count; ++tick) {
        x_m[0] = reflect(x_m[0] + mission.timing.dt_s * floor.step(tick, x_m), mission.domain);
      }
      benchmark::DoNotOptimize(x_m);
    }
  }
  report(mission, state);
}

BENCHMARK(StudyRun)
    ->ArgNames({"agents", "looks_ahead"})
    ->ArgsProduct({{4, 16, 64}, {0, 1}})
    ->Unit(benchmark::kMillisecond);
BENCHMARK(StudyRun)
    ->ArgNames({"agents", "looks_ahead"})
    ->Args({4, 1})
    ->Threads(2)
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK(TeamStep)
    ->ArgNames({"agents", "anticipation"})
    ->ArgsProduct({{64}, {0, 2}})
    ->Unit(benchmark::kMicrosecond);
BENCHMARK(StudyFloor)->Unit(benchmark::kMillisecond);
BENCHMARK(StudyFloor)->Threads(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ergocast::bench

BENCHMARK_MAIN();
