// SPDX-License-Identifier: BSD-3-Clause
// Finds the runs that a command without a URL applies to.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <vector>

#include "cli/watch/run_registry.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {

/// The live runs of this user, or the one with that number. Prints a line for each unusable entry
/// of the registry.
/// @param run  0: all
std::vector<LiveRun> live_runs_named(RunId run);

/// Asks the user to choose one of several live runs; returns the exit code.
int choose(const std::vector<LiveRun>& runs);

/// Explains why a run that is still being prepared has no team; returns the exit code.
int report_preparing(const LiveRun& run);

/// Explains in --help where find_run() looks. @pre the command has --lcm-url
void describe_search(CLI::App& command);

/// Does nothing if --lcm-url or $LCM_DEFAULT_URL names a URL. Otherwise takes the only live run of
/// this user, or the one that --run-id names. Sets URL, run and key in `options`, and its folder in
/// `run_dir`. Without a live run nothing changes: the team may have been started by hand, on LCM's
/// own group. A run that still reads its scenario counts only if there is no other one. If several
/// runs are live or the run cannot be used, prints an error and returns an exit code.
/// @param command  that has the options
std::optional<int> find_run(const CLI::App& command, BusOptions& options,
                            std::filesystem::path* run_dir = nullptr);

/// The teams that a command for several teams applies to.
struct FoundRuns {
  std::vector<BusOptions> runs;
  std::vector<LiveRun> preparing{};  ///< they have no team yet
  int code = kExitDone;  ///< the exit code of unusable live runs; an error was printed for each
};

/// Returns the team on the given URL. Without a URL, returns every live run of this user, or the
/// one that --run-id names. If there is no live run, returns `options` unchanged.
/// @param command  that has the options
FoundRuns find_runs(const CLI::App& command, const BusOptions& options);

}  // namespace ergocast::cli
