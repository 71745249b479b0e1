// SPDX-License-Identifier: BSD-3-Clause
// How the agents of a recorded mission were, over time.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "core/mission.h"

namespace ergocast::cli {

/// Reads the event log of a run directory as a listener would have heard it: null if there is none,
/// else {"t": [mission time, …], "metric": [median of the agents' φ², …], "agents": {"0": {"state":
/// [index into "words", …], "phase": [index into "phases", …], "silent_s", "metric", "age_s",
/// "lag_s", "lost", "drops", "waits_for"}, …}, "words", "phases", "incidents"}. Each list has an
/// item for each t; null: not known.
///
/// A pause of all messages is one of the logger. It is left out, and so are the logger's own
/// absences: its log cannot tell them.
/// @param problem  set to what ended the reading before the log's end, if something did
nlohmann::ordered_json recorded_team(const std::filesystem::path& run_dir, const Mission& mission,
                                     std::string* problem = nullptr);

}  // namespace ergocast::cli
