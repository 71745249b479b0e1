// SPDX-License-Identifier: BSD-3-Clause
// Runs a library that reads a stranger's file in a child process with bounded memory and time.
//
// Such a file can ask for any amount of both, and a fault of the library ends only the child.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace ergocast {

/// Limit (Files of a scenario): memory of a library that reads a drawing or geodata [bytes]. Beyond
/// it: the scenario is refused.
inline constexpr std::size_t kMostChildBytes = std::size_t{768} << 20;
/// Limit (Files of a scenario): processor time of a library that reads a drawing or geodata [s].
/// Beyond it: the scenario is refused.
inline constexpr unsigned kMostChildSeconds = 20;

/// What `work` returns in a child process; nothing if the child fails, or needs more than the
/// limits above.
/// @param work  returns at most `most_bytes`, and prints nothing: its standard streams are closed
std::optional<std::string> in_bounded_child(std::size_t most_bytes,
                                            const std::function<std::string()>& work);

}  // namespace ergocast
