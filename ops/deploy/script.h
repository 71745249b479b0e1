// SPDX-License-Identifier: BSD-3-Clause
// What the shell scripts of `ergocast deploy` have in common.
#pragma once

#include "ops/deploy/deploy.h"

namespace ergocast {

/// `text` as one word of a shell, whatever it holds; quoted only where it has to be.
std::string shell_word(std::string_view text);

/// `head` with the script's name for %SCRIPT% and the multicast group for %GROUP%.
std::string script_head(std::string head, const std::string& name, const DeployMission& mission);

/// The variables mission, url, scenario_folder, scenario_files, keys, coordinator and hosts.
std::string script_settings(const std::vector<DeployHost>& hosts, const DeployMission& mission);

}  // namespace ergocast
