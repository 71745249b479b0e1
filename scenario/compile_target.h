// SPDX-License-Identifier: BSD-3-Clause
// From a target as it is written to the numbers that the agents get.
#pragma once

#include <optional>

#include "target/density_picture.h"
#include "scenario/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

struct CompiledTarget {
  Coefficients coefficients;  ///< μ of (3)
  DensityGrid density;        ///< in multiples of the uniform density, for people
};

/// Integrates the target and reads its maps; nothing if anything in the scenario is wrong. Reports
/// what only that shows: maps that cannot be used, parts of which nothing is left, too little mass,
/// a μ that is not exact enough.
/// @pre validate() found nothing wrong with domain, basis and target
std::optional<CompiledTarget> compile_target(const proto::Scenario& scenario, Checks& checks);

}  // namespace ergocast
