// SPDX-License-Identifier: BSD-3-Clause
// Checks whether vehicles can move as their scenario says.
#pragma once

#include "scenario/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Reports limits that are missing or have no effect, ways to brake that are too long for the
/// domain, and what no separation of such vehicles is proven for; of each kind of agents.
/// @pre the defaults are filled in
void validate_vehicle(const proto::Scenario& scenario, Checks& checks);

}  // namespace ergocast
