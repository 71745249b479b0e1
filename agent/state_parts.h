// SPDX-License-Identifier: BSD-3-Clause
// Whether all parts of a tick's WORLD_STATE have arrived, in any order.
#pragma once

#include <bitset>
#include <cstddef>

#include "core/base/ids.h"
#include "team/messages.h"

namespace ergocast {

class StateParts {
 public:
  void see(const WorldState& world) {
    const auto part = static_cast<std::size_t>(world.part);
    if (world.header.tick > tick_) {
      tick_ = world.header.tick;
      received_.reset();
    }
    if (world.header.tick != tick_ || part >= received_.size()) return;
    received_.set(part);
    wanted_ = static_cast<std::size_t>(world.parts);
  }

  /// Whether all parts of `tick` have arrived, or a newer tick has.
  bool complete(Tick tick) const { return tick_ > tick || received_.count() >= wanted_; }

 private:
  Tick tick_ = -1;  // the newest
  std::bitset<kMaxAgents / kMaxVehiclesPerState> received_;
  std::size_t wanted_ = 0;
};

}  // namespace ergocast
