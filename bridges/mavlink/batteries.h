// SPDX-License-Identifier: BSD-3-Clause
// The charge of the batteries by which a vehicle moves.
//
// Autopilots report each battery by BATTERY_STATUS, and one number for the vehicle by SYS_STATUS.
// What is known of single batteries counts, and of several the least. Batteries of avionics and of
// payload do not count. If no battery's charge was known within kOldestBattery, SYS_STATUS counts.
//
// A charge that the autopilot does not know is not known here, either. Energy consumed and cells'
// voltages say nothing of it: energy counts from the autopilot's start, perhaps with a battery that
// was half full.
#pragma once

#include <ergocast/core/base/ids.h>

#include <cstdint>
#include <map>

#include "bridges/mavlink/messages.h"

namespace ergocast::mavlink {

/// Limit: how old what BATTERY_STATUS said may be. Autopilots send it each 2 s or more often.
inline constexpr std::chrono::seconds kOldestBattery{10};

class Batteries {
 public:
  void take(const SysStatus& status) { whole_percent_ = status.battery_remaining; }
  void take(const BatteryStatus& status, Instant now);

  /// 0 to 100; −1: not known.
  int percent(Instant now) const;

 private:
  struct Reading {
    int percent = -1;
    Instant at{};
  };
  std::map<std::uint8_t, Reading> single_;  // whose charge was known once
  int whole_percent_ = -1;
};

}  // namespace ergocast::mavlink
