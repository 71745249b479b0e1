// SPDX-License-Identifier: BSD-3-Clause
// Compares the newest end with the notice that an end needs.
#include "core/mission/end_by_finding.h"

#include <algorithm>

#include "core/mission/hold.h"

namespace ergocast {
namespace {

/// How many ticks after a find the end may be: in lockstep two of notice and one that counts; in
/// real time the notice begins at the newest tick that the world can be at.
Tick longest_wait(const Timing& timing) { return 3 + 2 * notice_ticks(timing); }

}  // namespace

bool lacks_end_by_finding(const Mission& mission, const Amendments& list, int found, Tick tick) {
  const int wanted = mission.objects.end_when_found;
  if (wanted == 0 || found < wanted) return false;
  const bool has_room = list.ends.size() < kMaxEnds && list.named < kMaxAmendments;
  const Tick left = tick_count_of(mission.timing, list.ends) - counted_ticks(list.holds, tick);
  return has_room && left > longest_wait(mission.timing);
}

Tick soonest_tick_count(const Amendments& list, Tick from) {
  const Tick named = list.ends.empty() ? from : std::max(from, list.ends.back().from);
  return counted_ticks(list.holds, named) + 1;
}

Amendments without_end_by_finding(Amendments list) {
  const bool is_newest = !list.recent.empty() && !list.ends.empty() &&
                         list.recent.back().number == list.ends.back().number &&
                         list.ends.back().number + 1 == list.named &&
                         list.recent.back().by == kByFinding;
  if (!is_newest) return list;
  list.recent.pop_back();
  list.ends.pop_back();
  --list.named;
  return list;
}

std::string why_complete(const HiddenObjects& objects, int found) {
  if (objects.end_when_found == 0 || found < objects.end_when_found) return "mission complete";
  return std::to_string(found) + " of " + std::to_string(objects.total()) + " objects are found";
}

}  // namespace ergocast
