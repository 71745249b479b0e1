// SPDX-License-Identifier: BSD-3-Clause
// Goes through the ends in the order in which they were named.
#include "core/mission/end_schedule.h"

#include <limits>

#include "core/mission/station.h"

namespace ergocast {

void EndSchedule::note(std::span<const Hold> holds, std::span<const EndChange> ends) {
  changes_.clear();
  for (const EndChange& change : ends)
    changes_.push_back({counted_ticks(holds, change.from), change.tick_count});
}

Tick EndSchedule::tick_count_at(Tick counted) const {
  Tick tick_count = plan_;
  for (const Change& change : changes_)
    if (change.from <= counted) tick_count = change.tick_count;
  return tick_count;
}

Tick EndSchedule::rest_from(const Mission& mission, AgentId id, Tick counted) const {
  Tick rest = ergocast::rest_from(mission, id);
  if (changes_.empty() || rest == std::numeric_limits<Tick>::max()) return rest;
  const Tick reserve = plan_ - rest;
  for (const Change& change : changes_)
    if (change.from <= counted && change.from < rest) rest = change.tick_count - reserve;
  return rest;
}

}  // namespace ergocast
