// SPDX-License-Identifier: BSD-3-Clause
// Logs what was refused or lost on reception, at a limited rate. Renews the group membership when
// the network interface was replaced.
#pragma once

#include "core/base/ids.h"
#include "runtime/bus/transport.h"
#include "team/messages.h"

namespace ergocast {

class TrafficWatch {
 public:
  /// Logs at once if the kernel has no filters.
  explicit TrafficWatch(Transport& transport);

  /// To be called every turn. Checks once a second; logs changes at most every 10 s.
  /// @param late_commands  how many of the operator's commands were refused for their old ticks
  /// @return whether this turn checked; the caller then does its own work of once a second
  bool look(Instant now, std::int64_t late_commands = 0);
  std::int64_t kernel_drops() const { return kernel_drops_; }

 private:
  void warn_of_unknown_format(Instant now);
  void warn_of_late_commands(std::int64_t count, Instant now);

  Transport& transport_;
  Instant next_look_{}, next_log_{}, next_warning_{}, next_late_warning_{};
  std::int64_t warned_unknown_ = 0, warned_late_ = 0;
  std::int64_t kernel_drops_ = 0, logged_drops_ = 0, logged_over_rate_ = 0, logged_repeats_ = 0;
  RefusalCounts logged_{};
};

}  // namespace ergocast
