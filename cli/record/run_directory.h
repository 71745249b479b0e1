// SPDX-License-Identifier: BSD-3-Clause
// The run directory of a mission, and the closing lines of `run` and `simulate`.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/result.h"
#include "scenario/scenario.h"

namespace ergocast::cli {

/// Loads a scenario or lists all its problems on the standard error stream.
std::optional<Scenario> load_or_complain(const std::filesystem::path& file,
                                         const Overrides& overrides);

/// The mission of a run directory's plan.binpb, or an error on the standard error stream.
std::optional<Mission> recorded_mission_or_complain(const std::filesystem::path& run_dir);

/// When the mission of a run directory ends by its newest end, with the pauses before [s].
double recorded_end_s(const std::filesystem::path& run_dir, const Mission& mission);

/// Makes the folder (`wanted`, or runs/<scenario>-<time> if empty) and writes scenario.textproto,
/// plan.binpb and target_density.csv into it. An error if it cannot be written or is not empty.
Result<std::filesystem::path> prepare_run_directory(const std::filesystem::path& wanted,
                                                    const Scenario& scenario);

/// Writes the report, prints how the run ended, and prints the paths of all results.
void conclude(const std::filesystem::path& run_dir, const nlohmann::ordered_json& summary,
              const Scenario& scenario);

}  // namespace ergocast::cli
