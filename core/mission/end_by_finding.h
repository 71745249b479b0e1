// SPDX-License-Identifier: BSD-3-Clause
// A mission with objects may end once a number of them are found (world.objects.end_when_found).
//
// The coordinator then names an end, the next one that is possible (coordinator/amending.h). In
// lockstep the world stays at the tick of the last find until it knows that end. So all runs of a
// mission end at the same tick.
#pragma once

#include <string>

#include "core/base/ids.h"
#include "core/mission/amendments.h"
#include "core/mission/mission.h"

namespace ergocast {

/// The operator that the list names for such an end.
inline constexpr const char* kByFinding = "finding";

/// Whether so many objects are found at a tick of the world that the mission must end, and it has
/// neither an end that is near nor an end too many.
bool lacks_end_by_finding(const Mission& mission, const Amendments& list, int found, Tick tick);

/// The number of ticks of a mission that ends as soon as possible by an end that holds from a tick
/// on.
Tick soonest_tick_count(const Amendments& list, Tick from);

/// The list as it was before such an end was named; the same list if its newest amendment is none.
Amendments without_end_by_finding(Amendments list);

/// Why a mission is complete, for people: its time is over, or enough objects are found.
std::string why_complete(const HiddenObjects& objects, int found);

}  // namespace ergocast
