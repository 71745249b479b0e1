// SPDX-License-Identifier: BSD-3-Clause
// The two files of a mission key: the team's and the coordinator's.
#pragma once

#include <optional>
#include <string>

namespace ergocast::cli {

/// The key file of agents, world, driver, logger and monitors.
std::string team_key_file(const std::string& name);
/// The key file of the processes that start and end missions.
std::string coordinator_key_file(const std::string& name);

/// The reason why a team cannot use the two files of `name`, with the remedy; nullopt if it can.
std::optional<std::string> problem_of_key_pair(const std::string& name);

}  // namespace ergocast::cli
