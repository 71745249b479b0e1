// SPDX-License-Identifier: BSD-3-Clause
// `ergocast simulate`: simulates a mission into a run directory and shows how far it is.
#include "cli/commands.h"
#include "cli/progress.h"
#include "cli/report_error.h"
#include "cli/run_directory.h"
#include "cli/simulated_events.h"
#include "cli/simulated_record.h"
#include "runtime/signals.h"

namespace ergocast::cli {
namespace {

void show(const lab::Simulation& simulation, const Mission& mission, ProgressDisplay& display) {
  const Recorder& recorder = simulation.recorder();
  MissionProgress at;
  at.tick = at.world_tick = recorder.next_row();
  at.tick_count = mission.timing.tick_count;
  at.dt_s = mission.timing.dt_s;
  at.ergodic_metric = recorder.facts().ergodic_metric_last;
  at.agents_alive = at.agents_expected = static_cast<int>(mission.starts_m.size());
  at.free_domain = mission.basis.free_domain;
  display.show(at);
}

/// Shows the progress on the terminal; a signal ends the simulation.
std::variant<SimulatedRecord, std::string> simulate_and_show(RunRecord& record,
                                                             const Scenario& scenario,
                                                             bool event_log) {
  StopSignals signals;
  ProgressDisplay display;
  std::optional<SimulatedEvents> events;
  if (event_log) events.emplace(record.folder(), scenario.mission());
  const auto look = [&](lab::Simulation& simulation) {
    show(simulation, scenario.mission(), display);
    if (signals.take() > 0) simulation.end("Ctrl-C or SIGTERM");
  };
  return simulate_into(record, scenario, look, events ? &*events : nullptr);
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
  const auto simulated = simulate_and_show(*std::get<0>(created), *scenario, options.event_log);
  if (const auto* error = std::get_if<std::string>(&simulated)) {
    return report_error(kExitFailed, *error);
  }
  const auto& result = std::get<SimulatedRecord>(simulated);
  conclude(folder, result.summary, *scenario);
  return result.failed ? kExitFailed : kExitDone;
}

}  // namespace ergocast::cli
