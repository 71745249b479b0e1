// SPDX-License-Identifier: BSD-3-Clause
// When whoever hears nothing may take it that the mission is over: who is cut off while it ends
// does not hear of the end, and those who know of it are gone.
#pragma once

#include <algorithm>
#include <chrono>

#include "core/ids.h"
#include "core/mission.h"

namespace ergocast {

/// How long after the mission's end, as far as the plan tells, a world or a coordinator may still
/// turn up that is started again [wall s].
inline constexpr double kFarewellPatience_s = 30;

/// Whether a running mission must be over, of whose world and coordinator nothing has been heard
/// for `silence`, and whose newest tick was `newest`.
inline bool must_be_over(const Timing& timing, Tick newest, PacingClock::duration silence) {
  const auto ticks_left = static_cast<double>(timing.tick_count - std::max<Tick>(newest, 0));
  // In lockstep nobody knows how long it takes, but no tick may stay unanswered for longer.
  const double plan_s = timing.pace == Pace::kLockstep
                            ? timing.lockstep_timeout_s
                            : ticks_left * timing.dt_s / timing.realtime_factor;
  return std::chrono::duration<double>(silence).count() > plan_s + kFarewellPatience_s;
}

}  // namespace ergocast
