// SPDX-License-Identifier: BSD-3-Clause
// The amendments of a mission as JSON: in amendments.json with the numbers of their targets and the
// corners of zones and the numbers of laws, in summary.json without. docs/run_directory.md
// documents the keys.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>

#include "core/base/result.h"
#include "core/mission/mission.h"
#include "logger/received_amendments.h"

namespace ergocast {

/// Ticks that do not count, as JSON: for each pause its first tick, and the first tick that counts
/// again or null.
nlohmann::ordered_json holds_json(std::span<const Hold> holds);

/// What the summary lists, without the numbers of targets.
nlohmann::ordered_json amendments_json(const ReceivedAmendments& heard, double dt_s);

/// The text of amendments.json.
std::string amendments_text(const ReceivedAmendments& heard, double dt_s);

/// The amendments of a run directory: from amendments.json; without that file the pauses that
/// `summary` lists. An error if the file is damaged, or has a target that is none of `mission`.
Result<ReceivedAmendments> recorded_amendments(const std::filesystem::path& run_dir,
                                               const nlohmann::ordered_json& summary,
                                               const Mission& mission);

/// Why the targets of a run directory are not all known; nothing if they are.
std::optional<std::string> missing_target(const std::filesystem::path& run_dir,
                                          const nlohmann::ordered_json& summary,
                                          const ReceivedAmendments& heard);

}  // namespace ergocast
