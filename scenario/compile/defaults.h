// SPDX-License-Identifier: BSD-3-Clause
// Completes a scenario: command-line options, defaults, random starts.
#pragma once

#include <string>
#include <vector>

#include "scenario/parse/findings.h"
#include "scenario/parse/source.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// The names of all other files that the scenario names, as they stand in it.
std::vector<std::string*> file_names(proto::Scenario& scenario);

/// Writes `overrides` over the values of the file. From now on their problems are reported for the
/// command line.
void put_over(const Overrides& overrides, proto::Scenario& scenario, Findings& findings);

/// Gives every absent field that is not required its default, and maps their absolute paths; moves
/// starts and stations that are beyond the domain's edge only by rounding onto it. `file` gives the
/// scenario's name if the scenario has none; maps are in its folder.
void fill_in(proto::Scenario& scenario, const std::string& file);

/// Replaces random_count by that many listed starts, each a function of the seed and the agent.
/// @pre the scenario is valid
void draw_starts(proto::Scenario& scenario);

}  // namespace ergocast
