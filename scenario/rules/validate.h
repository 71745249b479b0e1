// SPDX-License-Identifier: BSD-3-Clause
// Checks whether a scenario can be run.
#pragma once

#include "scenario/rules/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Reports everything in `scenario` that breaks a limit of scenario.proto, except for problems that
/// only integration finds (scenario/compile/compile_target.h). A scenario without a target comes
/// from a plan.
/// @pre the defaults are filled in
void validate(const proto::Scenario& scenario, Checks& checks);

}  // namespace ergocast
