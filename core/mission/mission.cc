// SPDX-License-Identifier: BSD-3-Clause
// Computes when an agent broadcasts, and the mission of a judge.
#include "core/mission/mission.h"

#include <algorithm>
#include <utility>

#include "core/mission/end_schedule.h"

namespace ergocast {

Mission in_cosines(Mission mission) {
  if (!mission.basis.free_domain) return mission;
  mission.basis.free_domain = false;
  mission.basis.table_hash = 0;
  mission.basis.table = nullptr;
  mission.target_coefficients = std::move(mission.cosine_target);
  mission.cosine_target = {};
  return mission;
}

Tick next_broadcast(const Mission& mission, AgentId id, Tick tick, int block) {
  return next_broadcast(mission, EndSchedule(mission), id, tick, block);
}

Tick next_broadcast(const Mission& mission, const EndSchedule& ends, AgentId id, Tick tick,
                    int block) {
  const Tick period = mission.timing.broadcast_period_ticks;
  const Tick factor = block == 0 ? 1 : mission.timing.high_mode_period_factor;
  const Tick team = std::max<Tick>(1, static_cast<Tick>(mission.starts_m.size()));
  // High modes are sent together with low ones.
  const Tick turn = id * period / team % period + id * factor / team % factor * period;
  const Tick between = period * factor;
  const Tick next = tick + between - (tick - turn + between) % between;
  if (mission.kinds.empty()) return next;
  const Tick last = ends.rest_from(mission, id, tick) - 1;
  return tick < last ? std::min(next, last) : std::max(tick + 1, ends.tick_count_at(tick));
}

}  // namespace ergocast
