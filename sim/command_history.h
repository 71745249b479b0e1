// SPDX-License-Identifier: BSD-3-Clause
// The last two commands of one agent: which one is in force, and where its vehicle was.
//
// Commands arrive in any order and more than once. A restarted world computes from the last two
// where the vehicle is and how fast it moves.
#pragma once

#include <optional>

#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "team/messages.h"

namespace ergocast {

class CommandHistory {
 public:
  /// Takes in a command. A repeat of a tick changes nothing, unless it corrects the velocity to
  /// zero.
  void take(const Command& command);
  /// Forgets all commands: another incarnation drives the vehicle.
  void clear() { last_.reset(), before_.reset(); }
  /// From now on the last command wants no motion.
  void stand();

  /// The newest command; null: none has arrived.
  const Command* last() const { return last_ ? &*last_ : nullptr; }
  /// The command before it; null: it has not arrived.
  const Command* before() const { return before_ ? &*before_ : nullptr; }
  /// The tick that the newest command answers; −1: there is none, or its agent knows no position.
  Tick answered() const { return last_ ? last_->header.tick : -1; }

  /// Whether the newest command is in force at `tick`. In lockstep it is for its own tick. In real
  /// time it is held for Timing::command_hold_s.
  bool in_force(Tick tick, const Timing& timing) const;
  /// The velocity to drive with at `tick`: zero without a command in force.
  Eigen::Vector3d velocity_mps(Tick tick, const Timing& timing) const;

 private:
  void take_without_tick(const Command& command);

  std::optional<Command> last_, before_;
};

}  // namespace ergocast
