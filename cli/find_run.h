// SPDX-License-Identifier: BSD-3-Clause
// Which run a command is about that was given no URL.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>

#include "runtime/node.h"

namespace ergocast::cli {

/// If neither --lcm-url nor $LCM_DEFAULT_URL names a URL: gives `options` URL, run and key of the
/// only live run of this user, or of the one that --run-id names, and `run_dir` its folder. Nothing
/// changes if there is none: the team may have been started by hand, on LCM's own group. Returns an
/// exit code, after an error message, if several runs are live or the one cannot be used.
/// @param command  that has the options
std::optional<int> find_run(const CLI::App& command, BusOptions& options,
                            std::filesystem::path* run_dir = nullptr);

}  // namespace ergocast::cli
