// SPDX-License-Identifier: BSD-3-Clause
// Times teams of real processes on one host in real time, 10 ticks a second: the processor time of
// a message that is received, late commands, and losses.
//
// A delivery is a message that an agent has received. Its cost is the processor time of all
// processes of the team, with their mathematics, divided by the number of deliveries. The first two
// seconds of a mission do not count.
#include <benchmark/benchmark.h>
#include <sys/resource.h>

#include <array>
#include <chrono>
#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>

#include "runtime/process/child.h"
#include "tests/bench/temporary_folder.h"

namespace ergocast::bench {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

/// The work of only the longer mission, without the start of the processes.
constexpr int kShort_s = 2, kLong_s = 22;

/// @param law  what the scenario says of it besides the greatest speed
std::string scenario_text(const std::string& law, int agents, int period_ticks, int duration_s) {
  return "domain { size_x_m: 2000 size_y_m: 2000 }\ntarget { uniform_weight: 1 }\n"
         "basis { modes_x: 10 modes_y: 10 }\nlaw { u_max_mps: 10 " +
         law +
         " }\n"
         "time { dt_s: 0.1 duration_s: " +
         std::to_string(duration_s) +
         " pace: REALTIME broadcast_period_ticks: " + std::to_string(period_ticks) +
         " }\nagents { random_count: " + std::to_string(agents) + " }\n";
}

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

/// Processor time of all children that have ended [s].
double processor_s() {
  rusage usage{};
  getrusage(RUSAGE_CHILDREN, &usage);
  return seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
}

struct Measured {
  double used_s = 0, deliveries = 0, lost = 0, late = 0, drops = 0, commands = 0;
};

/// A mission by the real programs, or the error.
Result<Measured> measure(const std::string& law, int agents, int period_ticks, int duration_s) {
  const TemporaryFolder folder;
  const fs::path scenario = folder.path() / "team.textproto", log = folder.path() / "log";
  std::ofstream(scenario) << scenario_text(law, agents, period_ticks, duration_s);
  const double before_s = processor_s();
  auto started = Child::start({.command = {ERGOCAST_PROGRAM_DIR "/ergocast", "run", scenario,
                                           "--out", folder.path() / "run"},
                               .log = log,
                               .signal_if_orphaned = SIGTERM});
  if (!started) return failure(started.error());
  Child& launcher = *started;
  while (launcher.running()) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  if (launcher.exit_code() != 0) return failure(launcher.fate() + "\n" + last_lines(log, 10));
  std::ifstream file(folder.path() / "run" / "summary.json");
  const Json summary = Json::parse(file);
  Measured measured;
  measured.used_s = processor_s() - before_s;
  for (const Json& agent : summary.at("agents")) {
    measured.deliveries += agent.value("messages_received", 0.0);
    measured.lost += agent.value("contributions_lost", 0.0);
  }
  measured.late = summary.at("missed_deadlines").get<double>();
  measured.drops = summary.at("messages").value("kernel_drops", 0.0);
  measured.commands = agents * summary.at("ticks").get<double>();
  return measured;
}

void measure_team(benchmark::State& state, const std::string& law) {
  const auto agents = static_cast<int>(state.range(0)), period = static_cast<int>(state.range(1));
  for (auto _ : state) {
    std::array<Measured, 2> measured;
    for (const std::size_t i : {0, 1}) {
      const auto mission = measure(law, agents, period, i == 0 ? kShort_s : kLong_s);
      if (!mission) return state.SkipWithError(mission.error().c_str());
      measured[i] = *mission;
    }
    const double used_s = measured[1].used_s - measured[0].used_s;
    const double deliveries = measured[1].deliveries - measured[0].deliveries;
    state.SetIterationTime(used_s);
    state.counters["us_per_delivery"] = 1e6 * used_s / deliveries;
    state.counters["deliveries_per_s"] = deliveries / (kLong_s - kShort_s);
    state.counters["cores"] = used_s / (kLong_s - kShort_s);
    state.counters["late_percent"] = 100 * measured[1].late / measured[1].commands;
    state.counters["lost"] = measured[1].lost;
    state.counters["drops"] = measured[1].drops;
  }
}

void RealTime(benchmark::State& state) { measure_team(state, ""); }
BENCHMARK(RealTime)
    ->ArgNames({"agents", "period"})
    ->ArgsProduct({{32, 64, 128}, {1, 10}})
    ->UseManualTime()
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

/// On 64 × 64 cells.
void RealTimeSearch(benchmark::State& state) {
  measure_team(state, "kind: SEARCH } sensor { radius_m: 31");
}
BENCHMARK(RealTimeSearch)
    ->ArgNames({"agents", "period"})
    ->Args({64, 10})
    ->UseManualTime()
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace ergocast::bench
