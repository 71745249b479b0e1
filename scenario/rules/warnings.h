// SPDX-License-Identifier: BSD-3-Clause
// Warns of settings that are allowed but probably not intended.
#pragma once

#include "core/mission/mission.h"
#include "scenario/parse/findings.h"
#include "target/density_picture.h"

namespace ergocast {

/// Adds the warnings about `mission`, which breaks no rule.
/// @param density  of its target
void warn(const Mission& mission, const DensityGrid& density, Findings& findings);

}  // namespace ergocast
