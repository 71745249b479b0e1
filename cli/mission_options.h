// SPDX-License-Identifier: BSD-3-Clause
// The options that the commands `run`, `simulate` and `study` share.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace ergocast::cli {

/// The options of every command that runs one mission.
struct MissionOptions {
  std::filesystem::path scenario;
  std::filesystem::path out;  ///< empty: runs/<scenario>-<time>
  Overrides overrides;
};

/// SCENARIO, --out and the options of `overrides`.
void add_mission_options(CLI::App& command, MissionOptions& options);

/// SCENARIO: a file, or the name of a shipped scenario.
void add_scenario_argument(CLI::App& command, std::filesystem::path& scenario);

/// RUN_DIR.
void add_run_dir_argument(CLI::App& command, std::filesystem::path& run_dir);

struct Seeds {
  std::uint64_t first = 1, last = 1;
  std::uint64_t count() const { return last - first + 1; }
};

/// --seeds FIRST:LAST.
CLI::Option* add_seeds_option(CLI::App& command, Seeds& seeds, const std::string& meaning);

/// --jobs, whose default is the number of processors.
CLI::Option* add_jobs_option(CLI::App& command, int& jobs);

}  // namespace ergocast::cli
