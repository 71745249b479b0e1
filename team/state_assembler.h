// SPDX-License-Identifier: BSD-3-Clause
// Puts the parts of a WORLD_STATE together, which arrive in any order and more than once.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/motion/separation.h"
#include "team/messages.h"

namespace ergocast {

/// Which parts of one state have arrived.
class ArrivedParts {
 public:
  /// Forgets all parts, and begins with this one.
  void begin(const WorldState& part);
  /// Adds a part. Parts of several drivers may differ in world and count: the largest count holds.
  void add(const WorldState& part);

  bool begun() const { return !arrived_.empty(); }
  /// Whether `part` is of the state with which it began: the same tick, world and count of parts.
  bool same(const WorldState& part) const;
  bool complete() const { return begun() && missing_ == 0; }
  /// −1 before the first part.
  Tick tick() const { return tick_; }

 private:
  Tick tick_ = -1;
  Incarnation world_ = 0;
  std::vector<bool> arrived_;
  std::size_t missing_ = 0;
};

/// Follows the newest tick of one world.
class StateAssembler {
 public:
  /// Takes in a part. A repeat replaces the part. A newer tick, another number of parts or another
  /// world begins anew; an older tick has no effect.
  void take(const WorldState& part);

  /// Whether all parts of exactly this tick have arrived, and no newer ones.
  bool complete(Tick tick) const { return tick == arrived_.tick() && newest() == tick; }
  /// The newest tick of which all parts have arrived; −1: none.
  Tick newest() const { return states().empty() ? -1 : states().front().header.tick; }
  /// The parts of newest(), in order.
  const std::vector<WorldState>& states() const { return arrived_.complete() ? parts_ : before_; }
  /// The vehicles at newest(), ascending by number, each with its speed limit in `mission`. Valid
  /// until the next call.
  std::span<const Neighbour> neighbours(const Mission& mission);

 private:
  ArrivedParts arrived_;
  std::vector<WorldState> parts_;   // those that have arrived are valid
  std::vector<WorldState> before_;  // the last complete state, while the next one is not complete
  std::vector<Neighbour> neighbours_;
};

}  // namespace ergocast
