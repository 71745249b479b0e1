// SPDX-License-Identifier: BSD-3-Clause
// Times a whole team in one process with encoded messages: the speed of the laboratory on one core.
//
// An iteration is one mission from the first HELLO to the last row of its record. The record is
// written as in a run, but discarded.
#include "lab/simulation.h"

#include <benchmark/benchmark.h>

#include <optional>
#include <string>

#include "logger/null_buffer.h"
#include "plan/plan.h"
#include "scenario/scenario.h"

namespace ergocast::bench {
namespace {

void Simulation(benchmark::State& state, const std::string& name) {
  const std::string file = std::string(ERGOCAST_SCENARIO_DIR) + '/' + name + ".textproto";
  Overrides overrides;
  overrides.agents = static_cast<int>(state.range(0));
  overrides.duration_s = 2400.0 / *overrides.agents;  // long enough for the start not to count
  const auto scenario = Scenario::load(file, overrides);
  if (!scenario) return state.SkipWithError("the scenario cannot be loaded");

  NullBuffer nowhere;
  std::int64_t messages = 0, agent_steps = 0;
  for (auto _ : state) {
    state.PauseTiming();  // reading the plan and integrating the target do not count
    std::optional<lab::Simulation> simulation;
    simulation.emplace(lab::SimulationOptions{.plan = encode_plan(scenario->mission())}, nowhere,
                       nowhere);
    state.ResumeTiming();
    simulation->run();
    state.PauseTiming();
    messages += simulation->counts().messages;
    agent_steps += simulation->recorder().facts().ticks * simulation->agent_count();
    simulation.reset();
    state.ResumeTiming();
  }
  using benchmark::Counter;
  state.counters["agent_steps_per_s"] = Counter(static_cast<double>(agent_steps), Counter::kIsRate);
  state.counters["messages_per_step"] =
      static_cast<double>(messages) / static_cast<double>(agent_steps);
}

void each_size(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgName("agents")->Arg(4)->Arg(64)->Unit(benchmark::kMillisecond);
}

BENCHMARK_CAPTURE(Simulation, paper_fig1a, "paper_fig1a")->Apply(each_size);
BENCHMARK_CAPTURE(Simulation, quadrimodal_corners, "quadrimodal_corners")->Apply(each_size);

}  // namespace
}  // namespace ergocast::bench

BENCHMARK_MAIN();
