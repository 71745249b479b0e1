// SPDX-License-Identifier: BSD-3-Clause
// What a scenario file leaves open: the command line's words, the defaults, the random starts.
#pragma once

#include <string>

#include "scenario/findings.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Writes `overrides` over what the file says. From now on their problems are the command line's.
void put_over(const Overrides& overrides, proto::Scenario& scenario, Findings& findings);

/// Gives every field that is left out, and not required, its value, and maps their whole paths. `file`
/// names a scenario that does not name itself; maps are in its folder.
void fill_in(proto::Scenario& scenario, const std::string& file);

/// Replaces random_count by that many listed starts, each a function of the seed and the agent.
/// @pre the scenario is valid
void draw_starts(proto::Scenario& scenario);

}  // namespace ergocast
