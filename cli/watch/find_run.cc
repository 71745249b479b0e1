// SPDX-License-Identifier: BSD-3-Clause
// Reads the registry of live runs.
#include "cli/watch/find_run.h"

#include <algorithm>
#include <utility>

#include "cli/report_error.h"
#include "runtime/process/key_file.h"

namespace ergocast::cli {
namespace {

/// Returns the live runs; prints a line for each unusable entry.
std::vector<LiveRun> runs_here() {
  LiveRuns found = live_runs();
  for (const std::string& warning : found.warnings) print_message("warning: " + warning);
  return std::move(found.runs);
}

/// Uses the key of the run, unless another one was given.
std::optional<int> take_key(const CLI::App& command, const LiveRun& run, BusOptions& options) {
  const CLI::Option* option = command.get_option_no_throw("--key-file");
  if (option == nullptr || option->count() > 0 || run.key_file.empty()) return std::nullopt;
  const auto key = read_key_file(run.key_file);
  if (!key) {
    return report_error(kExitBadInput, "run " + to_hex(run.run) + " of " + run.scenario +
                                           " has a mission key: " + key.error());
  }
  options.authenticator = MessageAuthenticator(*key);
  options.key_file = run.key_file;
  return std::nullopt;
}

/// Sets the URL, the run and its key. If the run cannot be used, prints an error and returns an
/// exit code.
std::optional<int> take(const CLI::App& command, const LiveRun& run, BusOptions& options) {
  if (run.version != version()) {
    return report_error(kExitBadInput, "run " + to_hex(run.run) + " of " + run.scenario +
                                           " was started with ergocast " + run.version +
                                           ", this is " + version() +
                                           ": use the command that started it");
  }
  options.url = run.url;
  options.run = run.run;
  return take_key(command, run, options);
}

}  // namespace

std::vector<LiveRun> live_runs_named(RunId run) {
  std::vector<LiveRun> runs = runs_here();
  if (run != 0) std::erase_if(runs, [run](const LiveRun& one) { return one.run != run; });
  return runs;
}

int choose(const std::vector<LiveRun>& runs) {
  std::string text = "several runs of this user are live; choose one with --run-id:";
  for (const LiveRun& run : runs) {
    text += "\n  --run-id " + to_hex(run.run) + "  " + run.scenario + ", since " + run.started +
            ", on " + run.url.base();
  }
  return report_error(kExitBadInput, text);
}

int report_preparing(const LiveRun& run) {
  return report_error(kExitFailed, "run " + to_hex(run.run) + " of " + run.scenario +
                                       " still reads its scenario and has no team yet: wait, or "
                                       "end it with `ergocast stop --now`");
}

void describe_search(CLI::App& command) {
  CLI::Option* url = command.get_option("--lcm-url");
  const std::string by_hand = url->get_default_str();
  url->default_str("")->description(
      "Base URL: swarm, world and command buses are this port and the next two (default: that of "
      "your live run on this host, which `ergocast list` names; if there is none, " +
      by_hand + ")");
  command.get_option("--run-id")->description("This run only; needed where several are live");
}

std::optional<int> find_run(const CLI::App& command, BusOptions& options,
                            std::filesystem::path* run_dir) {
  if (command.count("--lcm-url") > 0) return std::nullopt;
  std::vector<LiveRun> runs = live_runs_named(options.run);
  if (runs.empty()) return std::nullopt;
  const LiveRun first = runs.front();
  std::erase_if(runs, [](const LiveRun& run) { return run.preparing; });
  if (runs.empty()) return report_preparing(first);
  if (runs.size() > 1) return choose(runs);
  if (run_dir != nullptr) *run_dir = runs.front().run_dir;
  return take(command, runs.front(), options);
}

FoundRuns find_runs(const CLI::App& command, const BusOptions& options) {
  if (command.count("--lcm-url") > 0) return {{options}};
  const std::vector<LiveRun> live = live_runs_named(options.run);
  if (live.empty()) return {{options}};
  FoundRuns found;
  for (const LiveRun& run : live) {
    if (run.preparing) {
      found.preparing.push_back(run);
      continue;
    }
    BusOptions one = options;
    const auto code = take(command, run, one);
    code ? void(found.code = std::max(found.code, *code)) : found.runs.push_back(one);
  }
  return found;
}

}  // namespace ergocast::cli
