// SPDX-License-Identifier: BSD-3-Clause
// Warns of settings that are allowed but probably not intended.
#pragma once

#include "core/mission/mission.h"
#include "scenario/parse/findings.h"
#include "target/density_picture.h"

namespace ergocast {

/// Adds the warnings about `mission`, which breaks no rule, other than those of warn_of_target().
void warn(const Mission& mission, Findings& findings);

/// Adds the warnings about the target of `mission`.
/// @param density  of the target
void warn_of_target(const Mission& mission, const DensityGrid& density, Findings& findings);

}  // namespace ergocast
