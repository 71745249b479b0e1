// SPDX-License-Identifier: BSD-3-Clause
// The common parts of the shell scripts of `ergocast deploy`.
#pragma once

#include "cli/deploy/deploy.h"

namespace ergocast {

/// `head` with the script's name for %SCRIPT% and the multicast group for %GROUP%.
std::string script_head(std::string head, const std::string& name, const DeployMission& mission);

/// The shell function check_versions: unless each of `hosts` has `version`, it prints which one to
/// update and ends the script with 1.
extern const char* const kCheckVersion;

/// The variables version, mission, url, scenario_folder, scenario_files, keys, coordinator and
/// hosts.
std::string script_settings(const std::vector<DeployHost>& hosts, const DeployMission& mission);

}  // namespace ergocast
