// SPDX-License-Identifier: BSD-3-Clause
// Who has the three ports of a run open on this host.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ops/doctor/finding.h"
#include "runtime/lcm_url.h"

namespace ergocast::doctor {

struct Holder {
  int port = 0;
  std::string program;  ///< empty: somebody else's process, whose name this user may not see
  long pid = 0;
};

/// Who holds one of the URL's ports; one entry for each process and port.
/// @param proc  /proc, or a folder like it
std::vector<Holder> holders(const std::filesystem::path& proc, const LcmUrl& url);

/// @param refusal    why the base port cannot be opened beside them, if so
/// @param free_port  a base port that would be free, if one is known
Finding ports_finding(const LcmUrl& url, const std::vector<Holder>& holders,
                      const std::string& refusal, std::optional<int> free_port);

}  // namespace ergocast::doctor
