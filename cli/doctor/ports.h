// SPDX-License-Identifier: BSD-3-Clause
// Finds the processes of this host that have one of a run's three ports open.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cli/doctor/finding.h"
#include "runtime/bus/lcm_url.h"

namespace ergocast::doctor {

struct SocketOwner {
  int port = 0;
  std::string program;  ///< empty: another user's process, whose name is not readable
  long pid = 0;
};

/// The processes that hold one of the URL's ports; one entry for each process and port.
/// @param proc  /proc, or a folder like it
std::vector<SocketOwner> holders(const std::filesystem::path& proc, const LcmUrl& url);

/// @param refusal    why the base port cannot be opened beside these processes; empty if it can
/// @param free_port  a free base port, if one is known
Finding ports_finding(const LcmUrl& url, const std::vector<SocketOwner>& holders,
                      const std::string& refusal, std::optional<int> free_port);

}  // namespace ergocast::doctor
