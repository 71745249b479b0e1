// SPDX-License-Identifier: BSD-3-Clause
// Leaves out of a scenario what its mission's text leaves out.
#pragma once

#include "core/mission/mission.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Removes each field of the mission that is written with the value that it has without being
/// written (plan/mission_fields.h When), and the blocks that are then empty. So all scenarios of
/// one mission are printed alike, as logger/mission_text.h prints it.
/// @pre the scenario is valid, and `mission` is its mission
void omit_defaults(const Mission& mission, proto::Scenario& scenario);

}  // namespace ergocast
