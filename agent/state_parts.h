// SPDX-License-Identifier: BSD-3-Clause
// Whether all parts of a tick's WORLD_STATE have been heard, whatever their order.
#pragma once

#include <bitset>
#include <cstddef>

#include "core/ids.h"
#include "team/messages.h"

namespace ergocast {

class StateParts {
 public:
  void see(const WorldState& world) {
    const auto part = static_cast<std::size_t>(world.part);
    if (world.header.tick > tick_) {
      tick_ = world.header.tick;
      heard_.reset();
    }
    if (world.header.tick != tick_ || part >= heard_.size()) return;
    heard_.set(part);
    wanted_ = static_cast<std::size_t>(world.parts);
  }

  /// Whether no part of `tick` is missing that may still come.
  bool complete(Tick tick) const { return tick_ > tick || heard_.count() >= wanted_; }

 private:
  Tick tick_ = -1;  // the newest that was heard of
  std::bitset<kMaxAgents / kMaxVehiclesPerState> heard_;
  std::size_t wanted_ = 0;
};

}  // namespace ergocast
