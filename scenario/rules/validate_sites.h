// SPDX-License-Identifier: BSD-3-Clause
// Checks whether a team can be divided into sites.
#pragma once

#include "scenario/rules/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Checks the number of sites and of their members, and what a team of sites cannot have.
/// @pre the defaults are filled in, all other blocks have been checked
void validate_sites(const proto::Scenario& scenario, Checks& checks);

}  // namespace ergocast
