// SPDX-License-Identifier: BSD-3-Clause
// Late commands as people are told of them: their share, and the warning where it is notable.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/ids.h"

namespace ergocast {

/// The share of the commands that were missing when their tick ended.
/// @param ticks  that the world has had
double late_share(std::int64_t missed_deadlines, Tick ticks, int agents);

/// A sentence with the remedies; nothing below one in a hundred, or for a few late commands.
std::optional<std::string> overload_warning(std::int64_t missed_deadlines, Tick ticks, int agents);

}  // namespace ergocast
