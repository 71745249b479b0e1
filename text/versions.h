// SPDX-License-Identifier: BSD-3-Clause
// Compares the versions of two hosts, and names the host that needs an update.
#pragma once

#include <string>
#include <string_view>

namespace ergocast {

/// Whether `version` is older than `other`: their numbers are compared one by one, so "0.9.1" is
/// older than "0.10". A part that is no number counts as 0.
bool is_older_version(std::string_view version, std::string_view other);

/// "update rover1 to 0.3.0": which of two hosts has the older version.
/// @pre their versions differ
std::string update_of_hosts(const std::string& host, const std::string& version,
                            const std::string& other_host, const std::string& other_version);

}  // namespace ergocast
