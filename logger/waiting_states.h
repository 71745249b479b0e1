// SPDX-License-Identifier: BSD-3-Clause
// The world's states that wait to become rows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>

#include "core/base/ids.h"
#include "team/messages.h"
#include "team/state_assembler.h"

namespace ergocast {

/// Limit (Record): states that wait to become rows. Beyond it: newer ones are dropped, which leaves
/// a gap.
inline constexpr std::size_t kMaxWaitingStates = 1024;

/// The world at one tick, as far as its parts have arrived.
struct TickState {
  ArrivedParts parts;
  Tick uncounted_ticks = 0;          ///< before it; as its first part has it
  std::int64_t roster_revision = 0;  ///< likewise
  std::map<AgentId, Vehicle> vehicles;
  std::set<AgentId> lost;  ///< of these, the ones that add_lost() has put onto a line
};

class WaitingStates {
 public:
  /// Takes in a part. A complete state does not change any more: a repeat adds nothing, and in a
  /// restarted world's repeat the velocities may be missing.
  /// @param several_drivers  whether parts of different processes make up one state
  void take(const WorldState& part, bool several_drivers);
  /// Drops all states before `tick`.
  void drop_before(Tick tick) { states_.erase(states_.begin(), states_.lower_bound(tick)); }

  bool empty() const { return states_.empty(); }
  std::size_t size() const { return states_.size(); }
  bool has(Tick tick) const { return states_.contains(tick); }
  bool complete(Tick tick) const;
  /// @pre has(tick)
  const TickState& at(Tick tick) const { return states_.at(tick); }
  /// The newest tick. @pre !empty()
  Tick last() const { return states_.rbegin()->first; }
  /// Puts vehicles whose part of a state was lost onto the line to their places in a later state,
  /// up to kMostLostPlaces ticks after the state before. Returns how many. @pre has(tick)
  int add_lost(Tick tick, double dt_s);
  /// The first of the first two successive states that are complete.
  std::optional<Tick> first_pair() const;

 private:
  std::map<Tick, TickState> states_;
};

}  // namespace ergocast
