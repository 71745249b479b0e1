// SPDX-License-Identifier: BSD-3-Clause
// Counts the missing parts, and keeps the last complete state beside the newest one.
#include "team/state_assembler.h"

#include <algorithm>
#include <utility>

namespace ergocast {

void ArrivedParts::begin(const WorldState& part) {
  tick_ = part.header.tick;
  world_ = part.header.incarnation;
  arrived_.clear();
  missing_ = 0;
  add(part);
}

void ArrivedParts::add(const WorldState& part) {
  const auto count = std::max(arrived_.size(), static_cast<std::size_t>(part.parts));
  missing_ += count - arrived_.size();
  arrived_.resize(count);
  const auto at = static_cast<std::size_t>(part.part);
  if (at >= arrived_.size()) return;
  if (!arrived_[at]) --missing_;
  arrived_[at] = true;
}

bool ArrivedParts::same(const WorldState& part) const {
  return begun() && part.header.tick == tick_ && part.header.incarnation == world_ &&
         static_cast<std::size_t>(part.parts) == arrived_.size();
}

void StateAssembler::take(const WorldState& part) {
  if (part.header.tick < arrived_.tick() || part.part < 0 || part.part >= part.parts) return;
  if (arrived_.same(part)) {
    arrived_.add(part);
  } else {
    if (arrived_.complete()) std::swap(parts_, before_);
    arrived_.begin(part);
    parts_.resize(static_cast<std::size_t>(part.parts));
  }
  parts_[static_cast<std::size_t>(part.part)] = part;
}

std::span<const Neighbour> StateAssembler::neighbours(const Mission& mission) {
  neighbours_.clear();
  for (const WorldState& state : states()) {
    for (const Vehicle& vehicle : state.vehicles_in_part()) {
      neighbours_.push_back({vehicle.id, vehicle.position_m,
                             motion_of(mission, vehicle.id).speed_limit_mps, 0, true,
                             vehicle.velocity_mps});
    }
  }
  std::ranges::sort(neighbours_, {}, &Neighbour::id);
  return neighbours_;
}

}  // namespace ergocast
