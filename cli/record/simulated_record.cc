// SPDX-License-Identifier: BSD-3-Clause
// Steps the simulated team until the mission ends; its recorder writes the tables, this file the
// summary.
#include "cli/record/simulated_record.h"

#include <chrono>
#include <optional>
#include <string>
#include <utility>

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

}  // namespace

Result<SimulatedRecord> simulate_into(RunRecord& record, const Scenario& scenario,
                                      const std::function<void(lab::Simulation&)>& look,
                                      SimulatedEvents* events, Amendments amendments,
                                      const OwnLaw& law) {
  lab::Simulation simulation({.plan = encode_plan(scenario.mission()),
                              .version = version(),
                              .host = host_name(),
                              .amendments = std::move(amendments),
                              .laws = law.laws},
                             record.trajectory(), record.metrics(), events);
  const std::string started = wall_clock_text();
  const auto start = std::chrono::steady_clock::now();
  for (int turns = 1; simulation.step() && record.good(); ++turns) {
    if (turns % kTurnsBetweenLooks == 0) look(simulation);
  }
  const std::chrono::duration<double> wall_time = std::chrono::steady_clock::now() - start;

  SimulatedRecord result{summary_of(simulation.recorder(), scenario, started, wall_time.count(),
                                    events ? events->removed() : 0, law.name),
                         simulation.coordinator().state() == MissionState::kFailed ||
                             simulation.recorder().facts().no_metric_from.has_value()};
  auto error = record.flush();
  if (!error && events) error = events->flush();
  if (!error) error = write_amendments(simulation.recorder(), scenario, record);
  if (!error) error = write_file(record.folder() / kSummaryFile, to_text(result.summary));
  if (error) return failure(*error + "; the record is incomplete");
  return result;
}

}  // namespace ergocast::cli
