// SPDX-License-Identifier: BSD-3-Clause
// Checks whether walls are valid, and whether bodies can keep from them.
#pragma once

#include "scenario/rules/checks.h"
#include "scenario/scenario.pb.h"
#include "target/density_picture.h"

namespace ergocast {

/// Checks the walls and solid keep-outs, and what bodies need to keep from them.
/// @pre the defaults are filled in, all other blocks have been checked
void validate_walls(const proto::Scenario& scenario, Checks& checks);

/// Checks that the walls leave enough of the domain free, and do not cut it in parts.
/// @param density  of the target: the mass in a part is named
/// @pre nothing has been found yet
void validate_free_region(const Mission& mission, const DensityGrid& density, Checks& checks);

}  // namespace ergocast
