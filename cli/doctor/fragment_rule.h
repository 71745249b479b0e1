// SPDX-License-Identifier: BSD-3-Clause
// Checks whether the kernel drops LCM's fragments before they reach our sockets.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "cli/doctor/finding.h"
#include "runtime/bus/lcm_url.h"

namespace ergocast::doctor {

/// The output of `nft -j list ruleset`; nothing if this user may not ask, or nft is missing.
std::optional<std::string> nft_ruleset();

/// @param ruleset  JSON, as nft writes it
/// @param rules    our file with the rule
Finding fragment_rule_finding(const LcmUrl& url, const std::optional<std::string>& ruleset,
                              const std::filesystem::path& rules);

}  // namespace ergocast::doctor
