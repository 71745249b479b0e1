// SPDX-License-Identifier: BSD-3-Clause
// Steps the simulated team until the mission ends; its recorder writes the tables, this file the
// summary.
#include "cli/record/simulated_record.h"

#include <chrono>
#include <optional>
#include <string>
#include <utility>

#include "lab/simulation.h"
#include "lab/site_simulation.h"
#include "logger/amendments_file.h"
#include "logger/summary.h"
#include "plan/plan.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {
namespace {

/// Turns between two calls of `look`, which take time.
constexpr int kTurnsBetweenLooks = 256;

nlohmann::ordered_json summary_of(const Recorder& recorder, const Scenario& scenario,
                                  const std::string& started, double wall_time_s,
                                  int events_removed, const std::string& law) {
  RunContext context;
  context.started = started;
  context.run = recorder.run();
  context.version = version();
  context.build = build_text();
  context.scenario_hash = plan_hash(encode_plan(scenario.mission()));
  context.simulated = true;
  context.own_law = law;
  context.events_removed = events_removed;
  context.wall_time_s = wall_time_s;
  context.cpu_has_fma = cpu_has_fma();
  return summarize(recorder, context);
}

/// The numbers of new targets stand in no other file.
std::optional<std::string> write_amendments(const Recorder& recorder, const Scenario& scenario,
                                            const RunRecord& record) {
  if (recorder.amendments().all().empty()) return std::nullopt;
  return write_file(record.folder() / kAmendmentsFile,
                    amendments_text(recorder.amendments(), scenario.mission().timing.dt_s));
}

/// Steps until the mission is over or the disk is full. Returns the wall time [s].
/// @param turns_between_looks  because looks take time
template <class Simulated>
double run(Simulated& simulation, const RunRecord& record, int turns_between_looks,
           const std::function<void(SimulationInProgress&)>& look) {
  const auto start = std::chrono::steady_clock::now();
  SimulationInProgress progress{simulation.recorder(), [&simulation](std::string reason) {
                                  simulation.end(std::move(reason));
                                }};
  for (int turns = 1; simulation.step() && record.good(); ++turns) {
    if (turns % turns_between_looks == 0) look(progress);
  }
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Writes what the recorder does not.
Result<SimulatedRecord> write_rest(SimulatedRecord result, const Recorder& recorder,
                                   const Scenario& scenario, RunRecord& record,
                                   SimulatedEvents* events) {
  auto error = record.flush();
  if (!error && events) error = events->flush();
  if (!error) error = write_amendments(recorder, scenario, record);
  if (!error) error = write_file(record.folder() / kSummaryFile, to_text(result.summary));
  if (error) return failure(*error + "; the record is incomplete");
  return result;
}

Result<SimulatedRecord> simulate_sites_into(RunRecord& record, const Scenario& scenario,
                                            const std::function<void(SimulationInProgress&)>& look,
                                            const OwnLaw& law) {
  const std::string started = wall_clock_text();
  lab::SiteSimulation simulation(encode_plan(scenario.mission()), record.trajectory(),
                                 record.metrics(), law.laws);
  const double wall_time_s = run(simulation, record, 1, look);
  const Recorder& recorder = simulation.recorder();
  const bool failed = recorder.facts().no_metric_from.has_value();
  return write_rest({summary_of(recorder, scenario, started, wall_time_s, 0, law.name), failed},
                    recorder, scenario, record, nullptr);
}

}  // namespace

Result<SimulatedRecord> simulate_into(RunRecord& record, const Scenario& scenario,
                                      const std::function<void(SimulationInProgress&)>& look,
                                      SimulatedEvents* events, Amendments amendments,
                                      const OwnLaw& law) {
  if (scenario.mission().sites.any()) return simulate_sites_into(record, scenario, look, law);
  lab::Simulation simulation({.plan = encode_plan(scenario.mission()),
                              .version = version(),
                              .host = host_name(),
                              .amendments = std::move(amendments),
                              .laws = law.laws},
                             record.trajectory(), record.metrics(), events);
  const std::string started = wall_clock_text();
  const double wall_time_s = run(simulation, record, kTurnsBetweenLooks, look);
  const Recorder& recorder = simulation.recorder();
  const bool failed = simulation.coordinator().state() == MissionState::kFailed ||
                      recorder.facts().no_metric_from.has_value();
  return write_rest({summary_of(recorder, scenario, started, wall_time_s,
                                events ? events->removed() : 0, law.name),
                     failed},
                    recorder, scenario, record, events);
}

}  // namespace ergocast::cli
