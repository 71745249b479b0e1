// SPDX-License-Identifier: BSD-3-Clause
// Whether the kernel drops LCM's fragments before they reach anybody at our ports.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "ops/doctor/finding.h"
#include "runtime/lcm_url.h"

namespace ergocast::doctor {

/// What `nft -j list ruleset` says; nothing if this user may not ask, or there is no nft.
std::optional<std::string> nft_ruleset();

/// @param ruleset  JSON, as nft writes it
/// @param rules    our file with the rule
Finding fragment_rule_finding(const LcmUrl& url, const std::optional<std::string>& ruleset,
                              const std::filesystem::path& rules);

}  // namespace ergocast::doctor
