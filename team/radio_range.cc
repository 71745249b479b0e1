// SPDX-License-Identifier: BSD-3-Clause
// Compares the distance of two vehicles in the newest world state with the range.
#include "team/radio_range.h"

namespace ergocast {

void RadioRange::on(const WorldState& world) {
  if (!limited() || world.header.tick < tick_) return;
  tick_ = world.header.tick;
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    positions_m_[vehicle.id] = vehicle.position_m;
  }
}

bool RadioRange::receives(AgentId listener, AgentId transmitter) const {
  if (!limited()) return true;
  const auto here = positions_m_.find(listener);
  const auto there = positions_m_.find(transmitter);
  if (here == positions_m_.end() || there == positions_m_.end()) return true;
  return (here->second - there->second).norm() <= range_m_;
}

}  // namespace ergocast
