// SPDX-License-Identifier: BSD-3-Clause
// Simulates the mission of a record again and compares every file that the simulation determines.
// The order is: the sources of the plan, the trajectory, and the files that follow from both.
#include <cstdio>
#include <memory>
#include <optional>
#include <sstream>
#include <utility>

#include "cli/commands.h"
#include "cli/mission_options.h"
#include "cli/record/record_comparison.h"
#include "cli/record/run_directory.h"
#include "cli/record/trajectory_comparison.h"
#include "cli/report_error.h"
#include "core/base/ids.h"
#include "core/mission/amendments.h"
#include "core/mission/end_by_finding.h"
#include "lab/simulation.h"
#include "lab/site_simulation.h"
#include "logger/amendments_file.h"
#include "logger/recorder.h"
#include "logger/run_data.h"
#include "logger/run_record.h"
#include "logger/summary.h"
#include "plan/amendment_list.h"
#include "plan/plan.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kTurnsBetweenComparisons = 256;

/// The simulation of a plan, as its recorder writes it.
struct Repetition {
  Repetition(const Mission& mission, Amendments amendments) {
    const std::vector<std::byte> plan = encode_plan(mission);
    if (mission.sites.any()) {
      sites.emplace(plan, trajectory, metrics);
    } else {
      simulation.emplace(
          lab::SimulationOptions{
              .plan = plan, .version = version(), .amendments = std::move(amendments)},
          trajectory, metrics);
    }
  }

  bool step() { return sites ? sites->step() : simulation->step(); }
  const Recorder& recorder() const { return sites ? sites->recorder() : simulation->recorder(); }

  /// Runs until the first difference or the end of either trajectory.
  void run(TrajectoryComparison& comparison) {
    bool more = true;
    for (bool going_on = true; more && going_on;) {
      const int turns = sites ? 1 : kTurnsBetweenComparisons;
      for (int i = 0; i < turns && more; ++i) more = step();
      std::istringstream rows(std::exchange(trajectory, std::ostringstream()).str());
      going_on = comparison.compare(rows);
    }
  }

  std::ostringstream trajectory, metrics;
  std::optional<lab::Simulation> simulation;
  std::optional<lab::SiteSimulation> sites;
};

/// A recorder that received only the recorded rows, and the tables that it writes.
struct Observer {
  Observer(RunData rows, const MissionFollower& heard) : recorder(0, 1, trajectory, metrics) {
    recorder.resume(std::move(rows));
    for (const MissionPart& part : heard.parts()) {
      recorder.receive(part, Bus::kSwarm, kCoordinator, Instant{});
    }
  }

  std::ostringstream trajectory, metrics;
  Recorder recorder;
};

/// Whether `summary` is of a simulation, whose run id comes from the seed.
bool is_simulated(const Json& summary, const Recorder& simulated) {
  return summary.value("run_id", Json()) == to_hex(simulated.run());
}

/// The reason why a simulation cannot reproduce everything in a run over LCM; empty if it can.
std::string what_cannot_be_repeated(const Json& summary, const Mission& mission) {
  if (mission.timing.pace == Pace::kRealtime) {
    return "it ran in real time, where what an agent knew depended on the network";
  }
  for (const auto& process : summary.value("processes", Json::array())) {
    if (process.at("name") == "world")
      return "another program than ergocast-sim moved its vehicles (run --world)";
  }
  const auto roster = summary.value("agents", Json());
  const std::size_t agents = mission.starts_m.size();
  if (!roster.is_array()) return "its summary names no agents";
  if (roster.size() != agents) {
    return "its roster has " + std::to_string(roster.size()) + " entries for " +
           std::to_string(agents) + " agents: agents were restarted, or never came";
  }
  if (const auto recalls = summary.value("recalls", Json::array()); !recalls.empty()) {
    return "the operator recalled agent " + recalls.at(0).at("agent").dump() + " at tick " +
           recalls.at(0).at("from_tick").dump();
  }
  for (const auto& agent : roster) {
    const std::string who = "agent " + agent.at("id").dump();
    if (!agent.at("active_until").is_null()) {
      return who + " left or was evicted at tick " + agent.at("active_until").dump();
    }
    if (agent.at("active_from") != 0) {
      return who + " joined at tick " + agent.at("active_from").dump();
    }
    const auto switched = agent.value("coverage_switched_at", nlohmann::ordered_json());
    if (!switched.is_null()) {
      return "coverage of " + who +
             " did not count for a while: it was last forgotten or counted again at tick " +
             switched.dump();
    }
  }
  return "";
}

/// The same for JSON of any origin.
std::string why_not_repeatable(const Json& summary, const Mission& mission) {
  try {
    return what_cannot_be_repeated(summary, mission);
  } catch (const Json::exception& error) {
    return std::string(kSummaryFile) + " is not one that ergocast wrote: " + error.what();
  }
}

/// The error of the trajectory as a whole; empty if there is none.
std::string difference_of(const TrajectoryComparison& comparison, const fs::path& run_dir,
                          const Json& summary) {
  const std::string file = (run_dir / kTrajectoryFile).string();
  const bool complete = summary.value("result", Json()) == "done";
  if (!comparison.same()) return comparison.difference();
  if (comparison.recorded_over() && complete) {
    return file + ": the summary reports a run that is done, but the file ends after tick " +
           comparison.last_tick() + '\n';
  }
  if (comparison.has_more())
    return file + ": goes on after the plan's last tick, or after all stood still\n";
  const Json gaps = summary.value("gaps", Json()), segments = summary.value("segments", Json());
  const bool tells_of_gaps = gaps.is_number_integer() && segments.is_number_integer();
  // A segment begins where a logger was killed, possibly within the rows of a tick.
  if (tells_of_gaps && comparison.missing() > gaps.get<Tick>() + segments.get<Tick>() - 1) {
    return file + ": lacks rows, first those of " + comparison.first_missing() + "; " +
           std::to_string(comparison.missing()) + " ticks lack rows, and the summary counts " +
           gaps.dump() + "\n";
  }
  if (comparison.torn() && !summary.empty()) {
    return file + ": ends amid tick " + comparison.last_tick() +
           ", but its logger ended in order\n";
  }
  return "";
}

int report_difference(const fs::path& run_dir, const std::string& difference,
                      const std::string& where = "") {
  std::printf("%s differs from its simulation%s\n%s", run_dir.c_str(), where.c_str(),
              printable(difference).c_str());
  return kExitDiffers;
}

/// Prints which files were compared and which were not.
void list(const fs::path& run_dir, const std::vector<FileComparison>& files) {
  std::printf("compared:\n");
  for (const FileComparison& file : files) {
    if (file.compared.empty()) continue;
    std::printf("  %-28s %s\n", file.file.c_str(), file.compared.c_str());
  }
  std::printf("not compared:\n");
  for (const FileComparison& file : files) {
    if (!file.left_out.empty())
      std::printf("  %-28s %s\n", file.file.c_str(), printable(file.left_out).c_str());
  }
  for (const auto& entry : fs::directory_iterator(run_dir)) {
    const std::string name = entry.path().filename().string();
    if (!name.ends_with(".lcm") && !name.ends_with(".lcm.zst") && name != "log") continue;
    std::printf("  %-28s messages and their times\n", name.c_str());
  }
}

/// Compares everything else that follows from the compared trajectory.
std::vector<FileComparison> compare_the_rest(const fs::path& run_dir, const Mission& mission,
                                             RunData rows, const ReceivedAmendments& amendments,
                                             const Repetition& repetition,
                                             const TrajectoryComparison& comparison,
                                             const Json& summary) {
  const Recorder& simulated = repetition.recorder();
  const bool complete = !comparison.recorded_over();
  const bool whole = complete && comparison.missing() == 0 && is_simulated(summary, simulated);
  rows.amendments = amendments;  // MISSION has the newest targets only
  const Observer observer(std::move(rows), simulated.follower());
  const Expectation expectation{.recorder = whole ? simulated : observer.recorder,
                                .metrics = (whole ? repetition.metrics : observer.metrics).str(),
                                .amendments = amendments,
                                .simulation = is_simulated(summary, simulated),
                                .whole = whole,
                                .complete = complete,
                                .closed = !summary.empty(),
                                .clamped_commands = simulated.facts().clamped_commands};
  std::vector<FileComparison> files{compare_metrics(run_dir, expectation)};
  if (!files.back().difference.empty()) return files;
  files.push_back(summary.empty() ? FileComparison{kSummaryFile, "", "is not there", ""}
                                  : compare_summary(run_dir, mission, summary, expectation));
  if (!files.back().difference.empty()) return files;
  files.push_back(compare_report(run_dir, mission));
  return files;
}

/// Prints the result; returns the exit code.
int conclude_verification(const fs::path& run_dir, const TrajectoryComparison& comparison,
                          const Json& summary, const std::vector<FileComparison>& files) {
  for (const FileComparison& file : files) {
    if (!file.difference.empty()) return report_difference(run_dir, file.difference);
  }
  const bool complete = summary.value("result", Json()) == "done";
  std::printf("%s: identical to its simulation, byte for byte, up to tick %s%s\n", run_dir.c_str(),
              comparison.last_tick().c_str(), complete ? "" : ", where the record ends");
  if (const Tick missing = comparison.missing(); missing > 0) {
    std::printf("%lld ticks before that are missing in the record\n",
                static_cast<long long>(missing));
  }
  list(run_dir, files);
  return kExitDone;
}

int verify(const fs::path& run_dir) {
  const auto mission = recorded_mission_or_complain(run_dir);
  if (!mission) return kExitBadInput;
  TrajectoryComparison comparison(run_dir);
  const TableLines metrics(run_dir, kMetricsFile, {kMetricsHeader});
  for (const auto& problem : {comparison.problem(), metrics.problem()}) {
    if (problem) return report_error(kExitBadInput, *problem);
  }
  auto read = read_summary(run_dir);
  if (!read) return report_error(kExitBadInput, read.error());
  Json& summary = *read;
  auto amendments = recorded_amendments(run_dir, summary, *mission);
  if (!amendments) return report_error(kExitBadInput, amendments.error());
  if (const auto reason = missing_target(run_dir, summary, *amendments))
    return report_error(kExitBadInput, run_dir.string() + " cannot be verified: " + *reason);
  if (const auto law = summary.is_object() ? summary.value("own_law", Json()) : Json();
      !law.is_null())
    return report_error(kExitBadInput, run_dir.string() +
                                           " cannot be verified: its agents followed " +
                                           law.dump() + ", a law of its user");
  std::optional<Repetition> repetition;
  repetition.emplace(*mission, amendments->list());
  if (!summary.is_object()) {
    print_message(run_dir.string() + ": no " + kSummaryFile +
                  ", so restarts are unknown; comparing anyway");
    summary = Json::object();
  } else if (!is_simulated(summary, repetition->recorder())) {
    const auto reason = why_not_repeatable(summary, *mission);
    if (!reason.empty())
      return report_error(kExitBadInput, run_dir.string() + " cannot be verified: " + reason);
  } else {
    // Its messages are compared, too: the end has to be named again.
    repetition.emplace(*mission, without_end_by_finding(amendments->list()));
  }

  std::vector<FileComparison> files = compare_sources(run_dir, *mission, summary);
  for (const FileComparison& file : files) {
    if (!file.difference.empty()) return report_difference(run_dir, file.difference);
  }
  if (summary.value("emergency_stop", Json()) == true) comparison.expect_halt();
  repetition->run(comparison);
  if (const auto& problem = comparison.problem()) return report_error(kExitBadInput, *problem);
  if (const auto difference = difference_of(comparison, run_dir, summary); !difference.empty()) {
    const std::string where = comparison.same() ? "" : ", first at " + comparison.place();
    return report_difference(run_dir, difference, where);
  }
  files.push_back({kTrajectoryFile, std::to_string(comparison.rows()) + " rows", "", ""});
  auto rows = read_tracks(run_dir);
  if (!rows) return report_difference(run_dir, rows.error() + '\n');
  auto rest = compare_the_rest(run_dir, *mission, *std::move(rows), *amendments, *repetition,
                               comparison, summary);
  for (FileComparison& file : rest) files.push_back(std::move(file));
  return conclude_verification(run_dir, comparison, summary, files);
}

}  // namespace

void add_verify(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("verify", "Simulate a recorded run again and compare the trajectories");
  auto run_dir = std::make_shared<std::filesystem::path>();
  add_run_dir_argument(*command, *run_dir);
  command->callback([&action, run_dir] { action = [run_dir] { return verify(*run_dir); }; });
}

}  // namespace ergocast::cli
