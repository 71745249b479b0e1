// SPDX-License-Identifier: BSD-3-Clause
// Measures the cost of a flood of repeats for a keyed team in real time. A process without the key
// records the team's messages and sends them again, unchanged, at a given rate.
//
// Lateness depends on the machine and its load, so no test depends on it.
// tests/process/flood_test.cc checks the properties that hold on any machine.
#include <benchmark/benchmark.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <thread>
#include <variant>

#include "runtime/bus/clock.h"
#include "runtime/bus/transport.h"
#include "runtime/process/child.h"
#include "runtime/process/key_file.h"
#include "tests/process/support/replayer.h"
#include "tests/support/own_host.h"

namespace ergocast::bench {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

const fs::path kScenario = fs::path(ERGOCAST_SCENARIO_DIR) / "quadrimodal_corners.textproto";
constexpr const char* kUrl = "udpm://239.255.76.67:24700?ttl=0";
constexpr int kAgents = 4;
constexpr auto kRecording = 12s, kFlood = 22s, kPause = 1s;

constexpr std::array<const char*, 4> kKinds = {"MISSION", "WORLD_STATE", "COMMAND", ""};

/// A keyed team in real time; its folder is removed with it.
class KeyedTeam {
 public:
  KeyedTeam() : key_(make_mission_key()) {
    std::string name = fs::temp_directory_path() / "ergocast-bench-XXXXXX";
    folder_ = mkdtemp(name.data());
    write_key_file(folder_ / "c.key", key_text(key_, true));
    mission_.emplace(
        Child::start({.command = {ERGOCAST_PROGRAM_DIR "/ergocast", "run", kScenario, "--realtime",
                                  "--duration", "100000", "--key-file", folder_ / "c.key",
                                  "--lcm-url", kUrl, "--out", folder_ / "run"},
                      .log = folder_ / "log",
                      .signal_if_orphaned = SIGTERM})
            .value());
  }
  ~KeyedTeam() {
    mission_->send(SIGINT);
    while (mission_->running()) std::this_thread::sleep_for(20ms);
    std::error_code ignored;
    if (getenv("ERGOCAST_BENCH_KEEP") == nullptr) fs::remove_all(folder_, ignored);
  }

  /// The team's reports: the world's tick, late commands, and the agents' losses.
  struct Says {
    Tick tick = -1;
    std::int64_t late = 0, lost = 0, drops = 0;
  };
  Says ask() const {
    Says says;
    std::map<AgentId, AgentStatus> agents;
    const auto ear =
        Transport::open(LcmUrl::parse(kUrl).value(), 0, MessageAuthenticator(key_),
                        subscriptions_of(Role::kMonitor),
                        {.on_message =
                             [&](const Message& message, Bus, AgentId) {
                               if (const auto* state = std::get_if<WorldState>(&message)) {
                                 says.tick = state->header.tick;
                                 says.late = state->missed_deadlines;
                               }
                               if (const auto* status = std::get_if<AgentStatus>(&message)) {
                                 if (status->phase == AgentPhase::kRunning)
                                   agents[status->header.sender] = *status;
                               }
                             }})
            .value();
    while (agents.size() < kAgents || says.tick < 0) ear->deliver_until(now() + 10ms, -1);
    for (const auto& [id, status] : agents) {
      says.lost += status.contributions_lost;
      says.drops += status.kernel_drops;
    }
    return says;
  }

 private:
  MissionKey key_;
  fs::path folder_;
  std::optional<Child> mission_;
};

/// Sends at that rate for that time, in bursts of a millisecond; returns the reached rate.
double flood(test::Replayer& replayer, double per_second, std::chrono::duration<double> time) {
  const auto start = Clock::now();
  std::size_t sent = 0;
  for (auto at = start; at - start < time; at = Clock::now()) {
    const auto due =
        static_cast<std::size_t>(per_second * std::chrono::duration<double>(at - start).count());
    // Datagrams that the machine was too slow to send are not sent later.
    replayer.replay(std::min<std::size_t>(due - std::min(due, sent), 1000));
    sent += std::min<std::size_t>(due - std::min(due, sent), 1000);
    std::this_thread::sleep_for(1ms);
  }
  return static_cast<double>(sent) / std::chrono::duration<double>(Clock::now() - start).count();
}

void Flood(benchmark::State& state) {
  KeyedTeam team;
  team.ask();
  test::Replayer replayer(LcmUrl::parse(kUrl).value(),
                          kKinds[static_cast<std::size_t>(state.range(0))]);
  for (const auto end = Clock::now() + kRecording; Clock::now() < end;) {
    replayer.listen();
    std::this_thread::sleep_for(10ms);
  }
  for (auto _ : state) {
    const auto before = team.ask();
    const double rate = flood(replayer, static_cast<double>(state.range(1)), kFlood);
    std::this_thread::sleep_for(kPause);
    const auto after = team.ask();
    const auto commands = static_cast<double>(kAgents * (after.tick - before.tick));
    const auto late = static_cast<double>(after.late - before.late);
    state.SetIterationTime(std::chrono::duration<double>(kFlood).count());
    state.counters["kept"] = static_cast<double>(replayer.kept());
    state.counters["sent_per_s"] = rate;
    state.counters["commands"] = commands;
    state.counters["late"] = late;
    state.counters["late_percent"] = 100 * late / commands;
    state.counters["lost"] = static_cast<double>(after.lost - before.lost);
    state.counters["drops"] = static_cast<double>(after.drops - before.drops);
  }
}

BENCHMARK(Flood)
    ->ArgNames({"kind", "per_s"})
    ->ArgsProduct({{0, 1, 2, 3}, {0, 49000, 100000}})
    ->UseManualTime()
    ->Iterations(1)
    ->Unit(benchmark::kSecond);

}  // namespace
}  // namespace ergocast::bench

int main(int argc, char** argv) {
  try {
    ergocast::test::enter_own_host();
  } catch (const std::exception& why) {
    std::fprintf(stderr, "%s: no program floods the network of this machine\n", why.what());
    return 3;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
}
