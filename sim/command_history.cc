// SPDX-License-Identifier: BSD-3-Clause
// Sorts commands into the newest and the one before it.
#include "sim/command_history.h"

#include <cstdlib>
#include <utility>

namespace ergocast {

void CommandHistory::take(const Command& command) {
  const Tick tick = command.header.tick;
  if (!last_ || tick > answered()) {
    before_ = std::exchange(last_, command);
  } else if (tick < answered()) {
    // Its successor has overtaken it.
    if (!before_ || tick > before_->header.tick) before_ = command;
  } else if (tick < 0) {
    take_without_tick(command);
  } else if (command.velocity_mps.isZero(0)) {
    stand();  // the only correction that an agent may send
  }
}

/// One of two commands without a tick may arrive before the answer to tick 0. Only two successive
/// ones show that there is no answer.
void CommandHistory::take_without_tick(const Command& command) {
  if (std::abs(command.header.sequence - last_->header.sequence) == 1) before_ = last_;
  last_ = command;
}

void CommandHistory::stand() {
  if (last_) last_->velocity_mps.setZero();
}

bool CommandHistory::in_force(Tick tick, const Timing& timing) const {
  if (answered() < 0) return false;
  const double age_s = static_cast<double>(tick - answered()) * timing.dt_s;
  return age_s <= (timing.pace == Pace::kRealtime ? timing.command_hold_s : 0);
}

Eigen::Vector3d CommandHistory::velocity_mps(Tick tick, const Timing& timing) const {
  return in_force(tick, timing) ? last_->velocity_mps : Eigen::Vector3d(0, 0, 0);
}

}  // namespace ergocast
