// SPDX-License-Identifier: BSD-3-Clause
// Whether the parts of a target are what scenario.proto says they must be.
#pragma once

#include "scenario/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Looks at the fields and at the names of maps, not into them.
/// @pre the defaults are filled in, and each number has been checked by itself
void validate_target(const proto::Scenario& scenario, Checks& checks);

}  // namespace ergocast
