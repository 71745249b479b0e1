// SPDX-License-Identifier: BSD-3-Clause
// Rounds the time to ticks.
#include "cli/record/new_end.h"

#include <algorithm>
#include <cmath>

#include "plan/mission_limits.h"
#include "text/read_number.h"
#include "text/shortest.h"

namespace ergocast::cli {

Result<Tick, std::string> EndWish::tick_count(const Timing& timing, Tick holds) const {
  const double ticks =
      std::round(seconds / timing.dt_s) + static_cast<double>(relative ? holds : 0);
  if (std::abs(ticks) <= limits::kMaxTicks) {
    const auto count = static_cast<Tick>(ticks);
    if (is_tick_count(count, timing)) return count;
  }
  const double most_s = std::min(limits::kDuration_s.high, limits::kMaxTicks * timing.dt_s);
  return failure("\"" + written + "\" is no end of this mission: an end is at t = " +
                 shortest(timing.dt_s) + " s to " + shortest(most_s) + " s, name one of these");
}

std::optional<EndWish> end_wish_from(std::string_view text) {
  EndWish wish{.written = std::string(text)};
  if (text.ends_with('s')) text.remove_suffix(1);
  wish.relative = text.starts_with('+') || text.starts_with('-');
  const bool negative = text.starts_with('-');
  if (wish.relative) text.remove_prefix(1);
  const auto value = read_number<double>(text);
  if (!value || !(*value >= 0) || !std::isfinite(*value)) return std::nullopt;
  wish.seconds = negative ? -*value : *value;
  return wish;
}

}  // namespace ergocast::cli
