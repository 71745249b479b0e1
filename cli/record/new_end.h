// SPDX-License-Identifier: BSD-3-Clause
// An end that an operator writes for a mission: at a mission time, or later or earlier than the end
// that holds.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "core/mission/mission.h"

namespace ergocast::cli {

struct EndWish {
  std::string written;
  bool relative = false;  ///< to the end that holds
  double seconds = 0;     ///< of mission time

  /// The number of ticks, in the place of those of the end that holds; an error says why no
  /// mission has as many.
  Result<Tick, std::string> tick_count(const Timing& timing, Tick holds) const;
};

/// The wish of "3600s", "+600s" or "-60s"; nothing for another text.
std::optional<EndWish> end_wish_from(std::string_view text);

}  // namespace ergocast::cli
