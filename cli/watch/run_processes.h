// SPDX-License-Identifier: BSD-3-Clause
// Which processes of this host belong to a run of `ergocast run`.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace ergocast::cli {

/// Name and process id of each running process that `launcher`, an `ergocast run`, has started, in
/// order of their starts. The names are those of the logs: "logger", "sim" or "world",
/// "coordinator", "agent-0" … Empty if there is no such process.
std::vector<std::pair<std::string, int>> processes_of_run(int launcher);

}  // namespace ergocast::cli
