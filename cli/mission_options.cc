// SPDX-License-Identifier: BSD-3-Clause
// Reads FIRST:LAST, and refuses ranges that no machine would finish.
#include "cli/mission_options.h"

#include <algorithm>
#include <string_view>
#include <thread>

#include "runtime/process/shipped_scenarios.h"
#include "scenario/parse/override_options.h"
#include "text/read_number.h"

namespace ergocast::cli {
namespace {

constexpr std::uint64_t kMostSeeds = 1000000000;

/// "A:B" or "A".
Seeds parse_seeds(const std::string& text) {
  const auto number = [&text](std::string_view part) {
    const auto value = read_number<std::uint64_t>(part);
    if (value) return *value;
    throw CLI::ValidationError("--seeds", "\"" + text + "\" is neither a number nor FIRST:LAST");
  };
  const std::string_view view = text;
  const std::size_t colon = view.find(':');
  if (colon == std::string_view::npos) return {number(view), number(view)};
  const Seeds seeds{number(view.substr(0, colon)), number(view.substr(colon + 1))};
  if (seeds.last < seeds.first || seeds.last - seeds.first >= kMostSeeds) {
    throw CLI::ValidationError("--seeds", text + ": the last must not be before the first, nor " +
                                              std::to_string(kMostSeeds) + " after it");
  }
  return seeds;
}

}  // namespace

void add_scenario_argument(CLI::App& command, std::filesystem::path& scenario) {
  command.add_option("SCENARIO", scenario, "Scenario file, or the name of a shipped one")
      ->required()
      ->transform(shipped_scenario())
      ->type_name("FILE");
}

void add_run_dir_argument(CLI::App& command, std::filesystem::path& run_dir) {
  command.add_option("RUN_DIR", run_dir, "Run directory")->required()->type_name("DIR");
}

void add_mission_options(CLI::App& command, MissionOptions& options) {
  add_scenario_argument(command, options.scenario);
  command
      .add_option("--out", options.out,
                  "Run directory: new or empty (default: runs/<scenario>-<time>)")
      ->type_name("DIR");
  add_override_options(command, options.overrides);
}

CLI::Option* add_seeds_option(CLI::App& command, Seeds& seeds, const std::string& meaning) {
  return command
      .add_option_function<std::string>(
          "--seeds", [&seeds](const std::string& text) { seeds = parse_seeds(text); }, meaning)
      ->type_name("FIRST:LAST");
}

CLI::Option* add_jobs_option(CLI::App& command, int& jobs) {
  jobs = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  return command.add_option("--jobs", jobs, "Worker processes (default: one for each processor)")
      ->check(CLI::Range(1, 1024));
}

}  // namespace ergocast::cli
