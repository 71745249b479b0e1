// SPDX-License-Identifier: BSD-3-Clause
// What a scenario may do, but will hardly want.
#pragma once

#include "core/mission.h"
#include "scenario/findings.h"

namespace ergocast {

/// Adds what `mission`, which breaks no rule, is to be warned of.
void warn(const Mission& mission, Findings& findings);

}  // namespace ergocast
