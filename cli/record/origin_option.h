// SPDX-License-Identifier: BSD-3-Clause
// --origin, for commands that need the place of a scenario on the earth.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <vector>

#include "scenario/origin.h"

namespace ergocast::cli {

/// --origin.
CLI::Option* add_origin_option(CLI::App& app, std::optional<GeoPlace>& origin);

/// The origin of the scenario in a run directory; nothing if it has none, or is not there.
Result<std::optional<GeoPlace>, std::vector<Problem>> recorded_origin(
    const std::filesystem::path& run_dir);

}  // namespace ergocast::cli
