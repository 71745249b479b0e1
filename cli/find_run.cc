// SPDX-License-Identifier: BSD-3-Clause
// Reads the registry of live runs; `ergocast list` prints it.
#include "cli/find_run.h"

#include <cstdio>
#include <nlohmann/json.hpp>

#include "cli/commands.h"
#include "cli/report_error.h"
#include "cli/run_registry.h"
#include "runtime/key_file.h"
#include "text/printable.h"

namespace ergocast::cli {
namespace {

/// The live runs, after a line for each entry of no use.
std::vector<LiveRun> runs_here() {
  LiveRuns found = live_runs();
  for (const std::string& warning : found.warnings) tell("warning: " + warning);
  return std::move(found.runs);
}

int choose(const std::vector<LiveRun>& runs) {
  std::string text = "several runs of this user are live; choose one with --run-id:";
  for (const LiveRun& run : runs) {
    text += "\n  --run-id " + to_hex(run.run) + "  " + run.scenario + ", since " + run.started +
            ", on " + run.url.base();
  }
  return report_error(kExitBadInput, text);
}

/// Takes the key of the run, unless another one was given.
std::optional<int> take_key(const CLI::App& command, const LiveRun& run, BusOptions& options) {
  const CLI::Option* option = command.get_option_no_throw("--key-file");
  if (option == nullptr || option->count() > 0 || run.key_file.empty()) return std::nullopt;
  const auto key = read_key_file(run.key_file);
  if (const auto* problem = std::get_if<std::string>(&key)) {
    return report_error(kExitBadInput, "run " + to_hex(run.run) + " of " + run.scenario +
                                           " has a mission key: " + *problem);
  }
  options.seal = MessageAuthenticator(std::get<MissionKey>(key));
  options.key_file = run.key_file;
  return std::nullopt;
}

void print_table(const std::vector<LiveRun>& runs) {
  if (runs.empty()) std::printf("no run of this user is live on this host\n");
  for (const LiveRun& run : runs) {
    std::printf("%s  %s, since %s, %s\n  %s\n  %s\n", to_hex(run.run).c_str(), run.scenario.c_str(),
                printable(run.started).c_str(),
                run.key_file.empty() ? "without a key" : "with a key", run.url.base().c_str(),
                printable(run.run_dir.string()).c_str());
  }
}

void print_json(const std::vector<LiveRun>& runs) {
  auto list = nlohmann::ordered_json::array();
  for (const LiveRun& run : runs) list.push_back(nlohmann::ordered_json::parse(to_json_text(run)));
  std::printf("%s\n", list.dump(2).c_str());
}

}  // namespace

std::optional<int> find_run(const CLI::App& command, BusOptions& options,
                            std::filesystem::path* run_dir) {
  if (command.count("--lcm-url") > 0) return std::nullopt;
  std::vector<LiveRun> runs = runs_here();
  if (options.run != 0) {
    std::erase_if(runs, [&options](const LiveRun& run) { return run.run != options.run; });
  }
  if (runs.empty()) return std::nullopt;
  if (runs.size() > 1) return choose(runs);
  const LiveRun& run = runs.front();
  if (run.version != version()) {
    return report_error(kExitBadInput, "run " + to_hex(run.run) + " of " + run.scenario +
                                           " is flown by ergocast " + run.version + ", this is " +
                                           version() + ": use the command that started it");
  }
  options.url = run.url;
  options.run = run.run;
  if (run_dir != nullptr) *run_dir = run.run_dir;
  return take_key(command, run, options);
}

void add_list(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("list", "Name the live runs that this user started here");
  auto json = std::make_shared<bool>(false);
  command->add_flag("--json", *json, "One JSON array");
  command->footer(
      "The runs of `ergocast run`; teams that were started by hand or on other hosts are not "
      "listed.\nstatus, watch, spy, stop, pause and resume take the only one, or the one that "
      "--run-id names.");
  command->callback([&action, json] {
    action = [json] {
      const std::vector<LiveRun> runs = runs_here();
      *json ? print_json(runs) : print_table(runs);
      return kExitDone;
    };
  });
}

}  // namespace ergocast::cli
