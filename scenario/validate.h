// SPDX-License-Identifier: BSD-3-Clause
// Whether a scenario can be flown.
#pragma once

#include "scenario/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Reports everything in `scenario` that breaks a limit stated in scenario.proto, but for what only
/// the integrals of its target show (compile_target.h). A scenario without a target is a plan's.
/// @pre the defaults are filled in
void validate(const proto::Scenario& scenario, Checks& checks);

}  // namespace ergocast
