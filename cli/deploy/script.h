// SPDX-License-Identifier: BSD-3-Clause
// The common parts of the shell scripts of `ergocast deploy`.
#pragma once

#include "cli/deploy/deploy.h"

namespace ergocast {

/// `head` with the script's name for %SCRIPT% and the multicast group for %GROUP%.
std::string script_head(std::string head, const std::string& name, const DeployMission& mission);

/// The variables mission, url, scenario_folder, scenario_files, keys, coordinator and hosts.
std::string script_settings(const std::vector<DeployHost>& hosts, const DeployMission& mission);

}  // namespace ergocast
