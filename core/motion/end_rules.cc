// SPDX-License-Identifier: BSD-3-Clause
// Compares the way home of each agent with the time until it has to rest.
#include "core/motion/end_rules.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/mission/end_schedule.h"
#include "core/mission/hold.h"
#include "core/mission/station.h"

namespace ergocast {

double EndRules::needed_s(const Mission& mission, const AgentPlace& agent,
                          const std::vector<Zone>& zones) {
  if (!agent.x_m) return std::numeric_limits<double>::infinity();
  WayHome& way = ways_.try_emplace(agent.id, mission, agent.id).first->second;
  way.note_zones(mission, zones);
  return way.needed_s(*agent.x_m);
}

EndProblem EndRules::problem(const Mission& mission, const Amendments& list, Tick tick, Tick from,
                             Tick tick_count, std::span<const AgentPlace> agents) {
  const double dt_s = mission.timing.dt_s;
  const Tick before = tick_count_of(mission.timing, list.ends);
  if (tick_count == before) return EndProblem::kSame;
  if (list.ends.size() >= kMaxEnds || list.named >= kMaxAmendments) return EndProblem::kFull;
  Amendments amended;
  amended.holds = list.holds;
  amended.ends = list.ends;
  name_end(amended, from, tick_count);
  const Tick counted_from = counted_ticks(list.holds, amended.ends.back().from);
  if (tick_count <= counted_from || before <= counted_from) return EndProblem::kPassed;
  if (tick_count > before) {
    const double left_s = static_cast<double>(before - counted_from) * dt_s;
    return left_s < kEndNotice_s ? EndProblem::kTooLate : EndProblem::kNone;
  }
  const EndSchedule now(mission, list), then(mission, amended);
  // The agent may go away from its station until it knows the end.
  const std::vector<Zone> zones = not_ended(list.zones, tick);
  const Tick away = counted_from - counted_ticks(list.holds, tick);
  for (const AgentPlace& agent : agents) {
    if (!station_of(mission, agent.id) || now.rests(mission, agent.id, counted_from)) continue;
    const Tick left = then.rest_from(mission, agent.id, counted_from) - counted_from - away;
    if (static_cast<double>(left) * dt_s >= needed_s(mission, agent, zones)) continue;
    too_far_ = agent.id;
    return EndProblem::kTooFar;
  }
  return EndProblem::kNone;
}

}  // namespace ergocast
