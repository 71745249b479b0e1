// SPDX-License-Identifier: BSD-3-Clause
// Derives from the mission how long its messages may gather.
#include "runtime/bus/gathering.h"

#include <algorithm>

#include "core/law/block_layout.h"

namespace ergocast {
namespace {

using std::chrono::duration;
using namespace std::chrono_literals;

constexpr duration<double> kMostGathered = 50ms, kLeastGathered = 1ms;

}  // namespace

Gathering gathering_of(const Mission& mission, std::size_t members) {
  const Timing& timing = mission.timing;
  const duration<double> half_a_tick(timing.dt_s / timing.realtime_factor / 2);
  if (timing.pace == Pace::kLockstep || half_a_tick < kLeastGathered) return {};
  const int blocks = block_count_of(mission);
  return {
      std::chrono::duration_cast<std::chrono::nanoseconds>(std::min(half_a_tick, kMostGathered)),
      members * static_cast<std::size_t>(blocks)};
}

}  // namespace ergocast
