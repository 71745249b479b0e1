// SPDX-License-Identifier: BSD-3-Clause
// Computes from a target as written the numbers that the agents receive.
#pragma once

#include <optional>

#include "scenario/rules/checks.h"
#include "scenario/scenario.pb.h"
#include "target/density_picture.h"

namespace ergocast {

struct CompiledTarget {
  Coefficients coefficients;  ///< μ of (3)
  DensityGrid density;        ///< in multiples of the uniform density, for people
};

/// Integrates the target and reads its maps; nothing if the scenario has any problem. Reports the
/// problems that only integration finds: unusable maps, parts that are cut off entirely, too little
/// mass, a μ that is not exact enough.
/// @pre validate() found no problem in domain, basis and target
std::optional<CompiledTarget> compile_target(const proto::Scenario& scenario, Checks& checks);

}  // namespace ergocast
