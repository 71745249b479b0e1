// SPDX-License-Identifier: BSD-3-Clause
// Checks other conditions of this host: Java for lcm-spy, the clock, the firewall.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "cli/doctor/finding.h"

namespace ergocast::doctor {

/// @param root  /, or a folder like it
/// @param path       $PATH
/// @param jar_built  whether our jar exists
Finding spy_finding(const std::filesystem::path& root, std::string_view path, bool jar_built);

/// Whether the kernel reports a synchronised clock; nothing if it is unknown.
std::optional<bool> clock_is_synchronised();
Finding clock_finding(std::optional<bool> synchronised);

/// The output of `nft list chains` and `iptables -S INPUT`, which only root can get.
std::string firewall_rules();
/// Whether the firewall drops packets without a rule; nothing if it is unknown from `rules`.
std::optional<Finding> firewall_finding(std::string_view rules, const std::string& group);

}  // namespace ergocast::doctor
