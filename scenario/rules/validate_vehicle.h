// SPDX-License-Identifier: BSD-3-Clause
// Checks whether vehicles can move as their scenario says.
#pragma once

#include "scenario/rules/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Checks each kind of agents. Reports limits that are missing or have no effect, braking paths
/// that are too long for the domain, and vehicles for which the separation is not proven.
/// @pre the defaults are filled in
void validate_vehicle(const proto::Scenario& scenario, Checks& checks);

}  // namespace ergocast
