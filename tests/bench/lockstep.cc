// SPDX-License-Identifier: BSD-3-Clause
// Times a whole team as processes over LCM. For comparison it times a ping-pong of datagrams of the
// same number and size between as many processes, without our codec and mathematics: directly over
// UDP, which is the lower bound, and over LCM.
//
// The real programs are started as a user starts them; the record has their speed.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "runtime/process/child.h"
#include "scenario/scenario.h"
#include "tests/bench/ping_pong.h"
#include "tests/bench/temporary_folder.h"

namespace ergocast::bench {
namespace {

namespace fs = std::filesystem;

/// About equally many datagrams for each team size.
double duration_s(int agents) { return std::max(20.0, 16000.0 / (agents * agents)); }
const fs::path kScenario = fs::path(ERGOCAST_SCENARIO_DIR) / "paper_fig1a.textproto";

/// Ticks per second of a mission by the real programs, or why there is no figure.
Result<double> run_mission(int agents) {
  const TemporaryFolder folder;
  const fs::path record = folder.path() / "run", log = folder.path() / "log";
  auto started = Child::start({.command = {ERGOCAST_PROGRAM_DIR "/ergocast", "run", kScenario,
                                           "--agents", std::to_string(agents), "--duration",
                                           std::to_string(duration_s(agents)), "--out", record},
                               .log = log,
                               .signal_if_orphaned = SIGTERM});
  if (!started) return failure(started.error());
  Child& launcher = *started;
  while (launcher.running()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  if (launcher.exit_code() != 0) {
    return failure("ergocast run " + launcher.fate() + "\n" + last_lines(log, 10));
  }
  std::ifstream summary(record / "summary.json");
  return nlohmann::json::parse(summary).at("ticks_per_s").get<double>();
}

void Lockstep(benchmark::State& state) {
  Overrides overrides;
  const auto agents = static_cast<int>(state.range(0));
  overrides.agents = agents;
  overrides.duration_s = duration_s(agents);
  const auto scenario = Scenario::load(kScenario, overrides);
  if (!scenario) return state.SkipWithError("the scenario cannot be loaded");
  const Traffic traffic = traffic_of(scenario->mission());

  const Tick ticks = scenario->mission().timing.tick_count;
  double ticks_per_s = 0, floor_ticks_per_s = 0, lcm_ticks_per_s = 0;
  for (auto _ : state) {
    const auto mission = run_mission(agents);
    if (!mission) return state.SkipWithError(mission.error().c_str());
    const auto floor = ping_pong(Carrier::kUdp, traffic, ticks);
    const auto lcm = ping_pong(Carrier::kLcm, traffic, ticks);
    if (!floor || !lcm) return state.SkipWithError("LCM cannot be used on this machine");
    ticks_per_s = *mission;
    floor_ticks_per_s = *floor;
    lcm_ticks_per_s = *lcm;
    state.SetIterationTime(1 / ticks_per_s);
  }
  state.counters["ticks_per_s"] = ticks_per_s;
  state.counters["floor_ticks_per_s"] = floor_ticks_per_s;
  state.counters["of_floor"] = ticks_per_s / floor_ticks_per_s;
  state.counters["lcm_ticks_per_s"] = lcm_ticks_per_s;
  state.counters["of_lcm"] = ticks_per_s / lcm_ticks_per_s;
}

// Each mission reports its figures; the time is per tick.
BENCHMARK(Lockstep)
    ->ArgName("agents")
    ->Arg(4)
    ->Arg(16)
    ->Arg(64)
    ->UseManualTime()
    ->Iterations(1)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace ergocast::bench
