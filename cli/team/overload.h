// SPDX-License-Identifier: BSD-3-Clause
// Reports late commands to people: their share, and a warning if it is large.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/base/ids.h"

namespace ergocast {

/// The share of the commands that were missing when their tick ended.
/// @param ticks  ticks of the world so far
double late_share(std::int64_t missed_deadlines, Tick ticks, int agents);

/// A warning with the remedies; empty below one in a hundred, or for a few late commands.
std::optional<std::string> overload_warning(std::int64_t missed_deadlines, Tick ticks, int agents);

}  // namespace ergocast
