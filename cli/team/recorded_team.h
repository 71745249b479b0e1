// SPDX-License-Identifier: BSD-3-Clause
// The state of a recorded mission's agents over time.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/mission/mission.h"

namespace ergocast::cli {

/// Reads the event log of a run directory as a listener would have received it. Returns null if
/// there is no log, else what AgentHistory::json() returns, with "incidents".
///
/// A time without any message is an absence of the logger, and is left out. Absences of the logger
/// itself are not reported, because its log cannot show them.
/// @param problem  set to the cause if reading ended before the log's end
nlohmann::ordered_json recorded_team(const std::filesystem::path& run_dir, const Mission& mission,
                                     std::string* problem = nullptr);

}  // namespace ergocast::cli
