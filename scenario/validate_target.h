// SPDX-License-Identifier: BSD-3-Clause
// Checks whether the parts of a target obey the rules of scenario.proto.
#pragma once

#include "scenario/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Checks the fields and the names of maps, not the content of maps.
/// @pre the defaults are filled in, and each number has been checked by itself
void validate_target(const proto::Scenario& scenario, Checks& checks);

}  // namespace ergocast
