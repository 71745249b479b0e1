// SPDX-License-Identifier: BSD-3-Clause
// `ergocast simulate`: steps the simulated team until the mission ends; its recorder writes the
// tables, this file the summary.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/report_error.h"
#include "cli/run_directory.h"
#include "lab/simulation.h"
#include "lcmtypes/channels.h"
#include "lcmtypes/codec.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "runtime/event_log.h"
#include "runtime/node.h"
#include "runtime/signals.h"
#include "team/plan.h"

namespace ergocast::cli {
namespace {

/// Turns between two updates of the display and checks for signals, which cost time.
constexpr int kTurnsBetweenLooks = 256;

void show(const lab::Simulation& simulation, const Mission& mission, ProgressDisplay& display) {
  const int agents = static_cast<int>(mission.starts_m.size());
  const Recorder& recorder = simulation.recorder();
  display.show({recorder.next_row(), mission.timing.tick_count, mission.timing.dt_s,
                recorder.facts().ergodic_metric_last, agents, agents});
}

nlohmann::ordered_json summary_of(const Recorder& recorder, const Scenario& scenario,
                                  const std::string& started, double wall_time_s,
                                  int events_removed) {
  RunContext context;
  context.started = started;
  context.run = recorder.run();
  context.version = version();
  context.build = build_text();
  context.scenario_hash = plan_hash(encode_plan(scenario.mission()));
  context.simulated = true;
  context.events_removed = events_removed;
  context.wall_time_s = wall_time_s;
  context.cpu_has_fma = cpu_has_fma();
  return summarize(recorder, context);
}

/// Writes the messages as the logger of a run would, at mission time.
class EventLogWriter : public lab::SimulationObserver {
 public:
  EventLogWriter(const std::filesystem::path& folder, const Mission& mission, std::int64_t start_us)
      : log_(folder), dt_s_(mission.timing.dt_s), start_us_(start_us) {}

  void says(lab::NodeId, const Outbox& outbox) override {
    for (const Outgoing& said : outbox) {
      if (const auto* world = std::get_if<WorldState>(&said.message))
        tick_ = std::max(tick_, world->header.tick);
      // Those on the command bus only repeat another bus.
      const bool repeats = std::holds_alternative<MissionPart>(said.message) ||
                           std::holds_alternative<Stop>(said.message);
      if (said.bus == Bus::kCommand && repeats) continue;
      encode(said.message, bytes_);
      const double t_us = 1e6 * static_cast<double>(tick_) * dt_s_;
      log_.write(channel_of(said.message, said.relayer), bytes_,
                 start_us_ + static_cast<std::int64_t>(t_us));
    }
  }
  std::optional<std::string> flush() { return log_.flush(); }
  int removed() const { return log_.removed(); }

 private:
  EventLog log_;
  double dt_s_;
  std::int64_t start_us_;
  Tick tick_ = 0;
  std::vector<std::byte> bytes_;
};

std::int64_t wall_clock_us() {
  using namespace std::chrono;
  return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

/// Runs until the mission is over, a signal arrives, or the disk is full. Returns the wall time.
double run(lab::Simulation& simulation, const Mission& mission, const RunRecord& record) {
  StopSignals signals;
  ProgressDisplay display;
  const auto start = std::chrono::steady_clock::now();
  int turns = 0;
  while (simulation.step()) {
    if (++turns % kTurnsBetweenLooks != 0) continue;
    show(simulation, mission, display);
    if (signals.take() > 0) simulation.end("Ctrl-C or SIGTERM");
    if (!record.good()) break;
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

int simulate(const MissionOptions& options) {
  const auto scenario = load_or_complain(options.scenario, options.overrides);
  if (!scenario) return kExitBadInput;
  const auto prepared = prepare_run_directory(options.out, *scenario);
  if (const auto* problem = std::get_if<std::string>(&prepared)) {
    return report_error(kExitBadInput, *problem);
  }
  const auto& folder = std::get<std::filesystem::path>(prepared);
  auto created = RunRecord::create(folder);
  if (const auto* problem = std::get_if<std::string>(&created)) {
    return report_error(kExitBadInput, *problem);
  }
  RunRecord& record = *std::get<0>(created);
  std::optional<EventLogWriter> events;
  if (options.event_log) events.emplace(folder, scenario->mission(), wall_clock_us());
  lab::Simulation simulation(
      {.plan = encode_plan(scenario->mission()), .version = version(), .host = host_name()},
      record.trajectory(), record.metrics(), events ? &*events : nullptr);

  const std::string started = wall_clock_text();
  const double wall_time_s = run(simulation, scenario->mission(), record);
  const auto summary = summary_of(simulation.recorder(), *scenario, started, wall_time_s,
                                  events ? events->removed() : 0);
  auto error = record.flush();
  if (!error && events) error = events->flush();
  if (!error) error = write_file(folder / kSummaryFile, to_text(summary));
  if (error) return report_error(kExitFailed, *error + "; the record is incomplete");
  conclude(folder, summary, *scenario);
  return simulation.coordinator().state() == MissionState::kFailed ? kExitFailed : kExitDone;
}

}  // namespace ergocast::cli
