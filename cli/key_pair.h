// SPDX-License-Identifier: BSD-3-Clause
// The two files of a mission key: the team's and the coordinator's.
#pragma once

#include <optional>
#include <string>

namespace ergocast::cli {

/// For every agent, world, driver, logger and whoever watches.
std::string team_key_file(const std::string& name);
/// For who begins and ends missions.
std::string coordinator_key_file(const std::string& name);

/// Why the files of `name` would not do for a team, with the remedy; nothing if they would.
std::optional<std::string> problem_of_key_pair(const std::string& name);

}  // namespace ergocast::cli
