// SPDX-License-Identifier: BSD-3-Clause
// Keeps the newest reading of each battery; the least that is new enough counts.
#include "bridges/mavlink/batteries.h"

#include <algorithm>

namespace ergocast::mavlink {

void Batteries::take(const BatteryStatus& status, Instant now) {
  constexpr std::uint8_t kAvionics = 3, kPayload = 4;  // MAV_BATTERY_FUNCTION
  const bool moves = status.battery_function != kAvionics && status.battery_function != kPayload;
  if (moves && status.battery_remaining >= 0) {
    single_[status.id] = {status.battery_remaining, now};
  } else {
    single_.erase(status.id);
  }
}

int Batteries::percent(Instant now) const {
  int least = -1;
  for (const auto& [id, reading] : single_) {
    if (now - reading.at <= kOldestBattery && (least < 0 || reading.percent < least))
      least = reading.percent;
  }
  return std::clamp(least >= 0 ? least : whole_percent_, -1, 100);
}

}  // namespace ergocast::mavlink
