// SPDX-License-Identifier: BSD-3-Clause
// Which run, or runs, a command is about that was given no URL.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <vector>

#include "cli/run_registry.h"
#include "runtime/node.h"

namespace ergocast::cli {

/// The live runs of this user, or the one with that number; after a line for each entry of the
/// registry that is of no use.
/// @param run  0: all
std::vector<LiveRun> live_runs_named(RunId run);

/// Asks to choose one of several live runs; the exit code.
int choose(const std::vector<LiveRun>& runs);

/// Says in --help where find_run() looks. @pre the command has --lcm-url
void describe_search(CLI::App& command);

/// If neither --lcm-url nor $LCM_DEFAULT_URL names a URL: gives `options` URL, run and key of the
/// only live run of this user, or of the one that --run-id names, and `run_dir` its folder. Nothing
/// changes if there is none: the team may have been started by hand, on LCM's own group. Returns an
/// exit code, after an error message, if several runs are live or the one cannot be used.
/// @param command  that has the options
std::optional<int> find_run(const CLI::App& command, BusOptions& options,
                            std::filesystem::path* run_dir = nullptr);

/// The teams that a command is about which takes more than one.
struct FoundRuns {
  std::vector<BusOptions> runs;
  int code = kExitDone;  ///< the exit code of live runs that cannot be used, after an error each
};

/// The team on the given URL; without one every live run of this user, or the one that --run-id
/// names; if there is none, `options` as they are.
/// @param command  that has the options
FoundRuns find_runs(const CLI::App& command, const BusOptions& options);

}  // namespace ergocast::cli
