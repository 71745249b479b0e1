// SPDX-License-Identifier: BSD-3-Clause
// `ergocast list`: prints the registry of live runs, and their processes.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/report_error.h"
#include "cli/watch/find_run.h"
#include "cli/watch/run_processes.h"
#include "text/printable.h"

namespace ergocast::cli {
namespace {

/// Above this size, a list of all processes would fill the screen.
constexpr std::size_t kMostNamed = 12;

struct ListOptions {
  bool json = false;
  RunId run = 0;
  std::string process;
};

void print_processes(const LiveRun& run) {
  const auto processes = processes_of_run(run.pid);
  std::string line = "run " + std::to_string(run.pid);
  for (std::size_t i = 0; i < std::min(processes.size(), kMostNamed); ++i)
    line += ", " + processes[i].first + ' ' + std::to_string(processes[i].second);
  if (processes.size() > kMostNamed) {
    line += " and " + std::to_string(processes.size() - kMostNamed) + " more, see --json";
  }
  std::printf("  processes: %s\n", printable(line).c_str());
}

void print_table(const std::vector<LiveRun>& runs) {
  if (runs.empty()) std::printf("no run of this user is live on this host\n");
  for (const LiveRun& run : runs) {
    if (run.preparing) {
      std::printf("%s  %s, since %s, still reads its scenario\n  processes: run %d\n",
                  to_hex(run.run).c_str(), run.scenario.c_str(), printable(run.started).c_str(),
                  run.pid);
      continue;
    }
    std::printf("%s  %s, since %s, %s\n  %s\n  %s\n", to_hex(run.run).c_str(), run.scenario.c_str(),
                printable(run.started).c_str(),
                run.key_file.empty() ? "without a key" : "with a key", run.url.base().c_str(),
                printable(run.run_dir.string()).c_str());
    print_processes(run);
  }
}

void print_json(const std::vector<LiveRun>& runs) {
  auto list = nlohmann::ordered_json::array();
  for (const LiveRun& run : runs) {
    auto json = nlohmann::ordered_json::parse(to_json_text(run));
    json["processes"] = nlohmann::ordered_json::object();
    for (const auto& [name, pid] : processes_of_run(run.pid)) json["processes"][name] = pid;
    list.push_back(std::move(json));
  }
  std::printf("%s\n", list.dump(2).c_str());
}

/// The process id of one process of the only run, for `kill`.
int print_process(const std::vector<LiveRun>& runs, const std::string& name) {
  if (runs.empty()) return report_error(kExitBadInput, "no such run of this user is live here");
  if (runs.size() > 1) return choose(runs);
  std::string others;
  for (const auto& [known, pid] : processes_of_run(runs.front().pid)) {
    if (known != name) {
      others += (others.empty() ? "" : ", ") + known;
      continue;
    }
    std::printf("%d\n", pid);
    return kExitDone;
  }
  return report_error(kExitBadInput, "run " + to_hex(runs.front().run) + " has no process " + name +
                                         " now; it has " + others);
}

int list(const ListOptions& options) {
  const std::vector<LiveRun> runs = live_runs_named(options.run);
  if (!options.process.empty()) return print_process(runs, options.process);
  options.json ? print_json(runs) : print_table(runs);
  return kExitDone;
}

}  // namespace

void add_list(CLI::App& app, Action& action) {
  auto* command =
      app.add_subcommand("list", "List the running missions that you started on this host");
  auto options = std::make_shared<ListOptions>();
  auto* json = command->add_flag("--json", options->json, "Print one JSON array");
  add_run_id_option(*command, options->run);
  command
      ->add_option("--pid", options->process,
                   "Print only the process id of this process: agent-N, coordinator, sim or logger")
      ->excludes(json)
      ->type_name("NAME");
  command->footer(
      "The runs of `ergocast run`; teams that were started by hand or on other hosts are not "
      "listed.\nstatus, watch, spy, stop, pause, resume, amend and recall take the only one, or "
      "the one "
      "that "
      "--run-id names;\nstop --now takes all.");
  command->callback([&action, options] { action = [options] { return list(*options); }; });
}

}  // namespace ergocast::cli
