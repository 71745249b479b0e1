// SPDX-License-Identifier: BSD-3-Clause
// The positions of all vehicles at a tick, from all parts of its WORLD_STATE in any order.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "core/motion/separation.h"
#include "team/messages.h"

namespace ergocast {

class Bodies {
 public:
  /// Takes in a part. A repeat replaces the part; a newer tick, another number of parts or another
  /// world begins anew.
  void see(const WorldState& world) {
    const auto parts = static_cast<std::size_t>(world.parts);
    const auto part = static_cast<std::size_t>(world.part);
    if (world.header.tick < tick_ || part >= parts) return;
    const bool same = world.header.tick == tick_ && world.header.incarnation == world_;
    if (!same || parts != parts_.size()) {
      tick_ = world.header.tick;
      world_ = world.header.incarnation;
      parts_.assign(parts, {});
      received_.assign(parts, false);
    }
    parts_[part] = world;
    received_[part] = true;
    if (std::find(received_.begin(), received_.end(), false) == received_.end()) whole_ = parts_;
  }

  /// Whether all parts of exactly this tick have arrived, and no newer ones.
  bool complete(Tick tick) const { return tick == tick_ && newest() == tick; }
  /// The newest tick of which all parts have arrived; −1: none.
  Tick newest() const { return whole_.empty() ? -1 : whole_.front().header.tick; }
  /// The parts of newest(), in order.
  const std::vector<WorldState>& states() const { return whole_; }

  /// The vehicles at newest(), ascending by number, each with its speed limit in `mission`.
  std::span<const Neighbour> neighbours(const Mission& mission) {
    neighbours_.clear();
    for (const WorldState& state : whole_) {
      for (int i = 0; i < state.vehicle_count; ++i) {
        const Vehicle& vehicle = state.vehicles[static_cast<std::size_t>(i)];
        neighbours_.push_back({vehicle.id, vehicle.position_m,
                               motion_of(mission, vehicle.id).speed_limit_mps, 0, true,
                               vehicle.velocity_mps});
      }
    }
    std::sort(neighbours_.begin(), neighbours_.end(),
              [](const Neighbour& a, const Neighbour& b) { return a.id < b.id; });
    return neighbours_;
  }

 private:
  Tick tick_ = -1;
  Incarnation world_ = 0;
  std::vector<WorldState> parts_, whole_;
  std::vector<bool> received_;
  std::vector<Neighbour> neighbours_;
};

}  // namespace ergocast
