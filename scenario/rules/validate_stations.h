// SPDX-License-Identifier: BSD-3-Clause
// Checks whether agents can stay at their stations, and get there in time.
#pragma once

#include "scenario/rules/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Checks how many stations a kind has, its reserve, and whether its vehicles can stay there: in
/// the domain, out of walls, apart from each other.
/// @pre the defaults are filled in, all other blocks have been checked
void validate_stations(const proto::Scenario& scenario, Checks& checks);

/// Checks that a way leads from each start to its station, and that the mission is long enough.
/// @pre nothing has been found yet
void validate_ways_home(const Mission& mission, Checks& checks);

}  // namespace ergocast
