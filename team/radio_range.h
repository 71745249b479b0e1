// SPDX-License-Identifier: BSD-3-Clause
// Decides which agents receive each other in a simulated world with a limited radio range.
#pragma once

#include <map>

#include "core/base/ids.h"
#include "team/messages.h"

namespace ergocast {

/// Positions from the newest world state, and the range rule: b receives what a transmits while
/// ‖x_a − x_b‖ ≤ range. A process without a known position reaches all agents.
class RadioRange {
 public:
  /// @param range_m  0: unlimited
  explicit RadioRange(double range_m = 0) : range_m_(range_m) {}

  bool limited() const { return range_m_ > 0; }
  void on(const WorldState& world);
  bool receives(AgentId listener, AgentId transmitter) const;

 private:
  double range_m_;
  Tick tick_ = -1;
  std::map<AgentId, Eigen::Vector3d> positions_m_;
};

}  // namespace ergocast
