// SPDX-License-Identifier: BSD-3-Clause
// Which processes of this host belong to a run of `ergocast run`.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace ergocast::cli {

/// Name and process id of each process that `launcher`, an `ergocast run`, has started and that has
/// not ended, in the order in which they were started: "logger", "sim" or "world", "coordinator",
/// "agent-0" …, as their logs are called. Empty if there is no such process.
std::vector<std::pair<std::string, int>> processes_of_run(int launcher);

}  // namespace ergocast::cli
