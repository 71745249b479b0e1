// SPDX-License-Identifier: BSD-3-Clause
// Warns of settings that are allowed but probably not intended.
#pragma once

#include "core/mission.h"
#include "scenario/findings.h"

namespace ergocast {

/// Adds the warnings about `mission`, which breaks no rule.
void warn(const Mission& mission, Findings& findings);

}  // namespace ergocast
