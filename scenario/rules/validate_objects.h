// SPDX-License-Identifier: BSD-3-Clause
// Checks whether objects to find are either counted or placed, in a plane and outside walls.
#pragma once

#include "scenario/rules/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// @pre the defaults are filled in, and domain and walls have been checked
void validate_objects(const proto::Scenario& scenario, Checks& checks);

}  // namespace ergocast
