// What a study makes of a core: missions without messages, and the numbers noted of them.
//
// An iteration is one mission. Two threads stand for the two worker processes of a study, which
// share nothing either. The floor is as many bare control steps, each of an agent by itself.
#include <benchmark/benchmark.h>

#include <string>
#include <vector>

#include "bench/step_floor.h"
#include "studies/study_run.h"
#include "scenario/scenario.h"

namespace ergocast::bench {
namespace {

const Mission& mission() {
  static const Mission mission = [] {
    Overrides overrides;
    overrides.duration_s = 600;
    const std::string file = std::string(ERGOCAST_SCENARIO_DIR) + "/quadrimodal_corners.textproto";
    return std::get<Scenario>(Scenario::load(file, overrides)).mission();
  }();
  return mission;
}

std::int64_t agent_steps() {
  return mission().timing.tick_count * static_cast<std::int64_t>(mission().starts_m.size());
}

void report(benchmark::State& state) {
  state.counters["agent_steps_per_s"] = benchmark::Counter(
      static_cast<double>(agent_steps() * static_cast<std::int64_t>(state.iterations())),
      benchmark::Counter::kIsRate);
}

void StudyRun(benchmark::State& state) {
  for (auto _ : state) {
    const studies::StudyFigures figures = studies::fly_without_messages(mission());
    benchmark::DoNotOptimize(figures.metric);
  }
  report(state);
}

void StudyFloor(benchmark::State& state) {
  for (auto _ : state) {
    for (const Eigen::Vector2d& start_m : mission().starts_m) {
      StepFloor floor(mission(), 1);
      Eigen::Vector2d x_m = start_m;
      for (Tick tick = 0; tick < mission().timing.tick_count; ++tick) {
        x_m = reflect(x_m + mission().timing.dt_s * floor.step(tick, x_m), mission().domain);
      }
      benchmark::DoNotOptimize(x_m);
    }
  }
  report(state);
}

BENCHMARK(StudyRun)->Unit(benchmark::kMillisecond);
BENCHMARK(StudyRun)->Threads(2)->UseRealTime()->Unit(benchmark::kMillisecond);
BENCHMARK(StudyFloor)->Unit(benchmark::kMillisecond);
BENCHMARK(StudyFloor)->Threads(2)->UseRealTime()->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace ergocast::bench

BENCHMARK_MAIN();
