// SPDX-License-Identifier: BSD-3-Clause
// `ergocast simulate`: simulates a mission into a run directory and shows how far it is.
#include <memory>
#include <utility>
#include <vector>

#include "cli/commands.h"
#include "cli/mission_options.h"
#include "cli/record/run_directory.h"
#include "cli/record/simulated_events.h"
#include "cli/record/simulated_record.h"
#include "cli/report_error.h"
#include "cli/study/planned_targets.h"
#include "cli/study/trials.h"
#include "cli/watch/progress.h"
#include "logger/summary.h"
#include "runtime/process/signals.h"

namespace ergocast::cli {
namespace {

void show(const Recorder& recorder, const Mission& mission, ProgressDisplay& display) {
  MissionProgress at;
  at.tick = at.world_tick = recorder.next_row();
  at.tick_count = tick_count_of(mission.timing, recorder.follower().amendments().ends);
  at.dt_s = mission.timing.dt_s;
  at.ergodic_metric = recorder.facts().ergodic_metric_last;
  at.agents_alive = at.agents_expected = static_cast<int>(mission.starts_m.size());
  at.free_domain = mission.basis.free_domain;
  display.show(at);
}

struct SimulateOptions : TrialsOptions {
  bool event_log = false;
  std::vector<PlannedAmendment> amendments;
};

/// Shows the progress on the terminal; a signal ends the simulation.
Result<SimulatedRecord> simulate_and_show(RunRecord& record, const Scenario& scenario,
                                          Amendments amendments, bool event_log) {
  StopSignals signals;
  ProgressDisplay display;
  std::optional<SimulatedEvents> events;
  if (event_log) events.emplace(record.folder(), scenario.mission());
  std::size_t finds_told = 0;
  const auto look = [&](SimulationInProgress& simulation) {
    const std::vector<Find>& finds = simulation.recorder.facts().finds.list();
    for (; finds_told < finds.size(); ++finds_told) display.print(to_text(finds[finds_told]));
    show(simulation.recorder, scenario.mission(), display);
    if (signals.take() > 0) simulation.end("Ctrl-C or SIGTERM");
  };
  return simulate_into(record, scenario, look, events ? &*events : nullptr, std::move(amendments));
}

/// What a simulated team of sites does not have; empty: nothing was asked of it.
std::string why_not_with_sites(const SimulateOptions& options, const Mission& mission) {
  if (!mission.sites.any()) return "";
  if (options.event_log) return "--event-log: a team of sites sends no messages yet (leave it out)";
  if (options.amendments.empty()) return "";
  return options.amendments.front().flag +
         ": nothing amends a team of sites yet (leave it out, or team.sites)";
}

int simulate(const SimulateOptions& options) {
  const MissionOptions& chosen = options.mission;
  const auto scenario = load_or_complain(chosen.scenario, chosen.overrides);
  if (!scenario) return kExitBadInput;
  if (const auto problem = why_not_with_sites(options, scenario->mission()); !problem.empty())
    return report_error(kExitBadInput, problem);
  auto amendments = amendments_with(options.amendments, *scenario, chosen.scenario);
  if (!amendments) return kExitBadInput;
  const auto folder = prepare_run_directory(chosen.out, *scenario);
  if (!folder) return report_error(kExitBadInput, folder.error());
  const auto record = RunRecord::create(*folder);
  if (!record) return report_error(kExitBadInput, record.error());
  const auto simulated =
      simulate_and_show(**record, *scenario, *std::move(amendments), options.event_log);
  if (!simulated) return report_error(kExitFailed, simulated.error());
  conclude(*folder, simulated->summary, *scenario);
  return simulated->failed ? kExitFailed : kExitDone;
}

}  // namespace

void add_simulate(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("simulate", "Run a mission in this process, in virtual time");
  auto options = std::make_shared<SimulateOptions>();
  add_mission_options(*command, options->mission);
  auto* seeds = add_seeds_option(*command, options->seeds,
                                 "One mission for each seed, in the laboratory; --out is then "
                                 "a CSV file")
                    ->excludes("--seed");
  command
      ->add_option("--faults", options->faults,
                   "Faults: a file, or \"swarm\" to draw them by the seed")
      ->type_name("FILE|swarm")
      ->needs(seeds);
  add_jobs_option(*command, options->jobs)->needs(seeds);
  add_amend_option(*command, options->amendments)->excludes(seeds);
  add_end_option(*command, options->amendments)->excludes(seeds);
  add_law_option(*command, options->amendments)->excludes(seeds);
  add_search_options(*command, options->amendments, seeds);
  command
      ->add_flag("--event-log", options->event_log,
                 "Write every message, as run does: events-000.lcm …")
      ->excludes(seeds);
  command->callback([&action, options, seeds] {
    action = [options, many = seeds->count() > 0] {
      return many ? trials(*options) : simulate(*options);
    };
  });
}

}  // namespace ergocast::cli
