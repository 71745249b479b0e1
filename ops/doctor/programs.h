// SPDX-License-Identifier: BSD-3-Clause
// What else on this host matters: Java for lcm-spy, the clock, the firewall.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "ops/doctor/finding.h"

namespace ergocast::doctor {

/// @param root  /, or a folder like it
/// @param path       $PATH
/// @param jar_built  whether our jar is there
Finding spy_finding(const std::filesystem::path& root, std::string_view path, bool jar_built);

/// Whether the kernel believes its clock to be synchronised; nothing if it does not say.
std::optional<bool> clock_is_synchronised();
Finding clock_finding(std::optional<bool> synchronised);

/// What `nft list chains` and `iptables -S INPUT` say, as far as root may ask them.
std::string firewall_rules();
/// Whether what no rule accepts is dropped; nothing if `rules` do not tell.
std::optional<Finding> firewall_finding(std::string_view rules, const std::string& group);

}  // namespace ergocast::doctor
