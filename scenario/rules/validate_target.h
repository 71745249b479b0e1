// SPDX-License-Identifier: BSD-3-Clause
// Checks whether the parts of a target obey the rules of scenario.proto.
#pragma once

#include "scenario/rules/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// All polygons together.
/// Limit (Scenario): vertices of all regions and keep-outs. Beyond it: the scenario is refused.
inline constexpr int kMaxVertices = 4096;
/// The least area of a polygon, by the domain's longer side [m].
constexpr double least_area_m2(double longer_side_m) {
  return 1e-8 * longer_side_m * longer_side_m;
}

/// Checks the fields and the names of maps, not the content of maps.
/// @pre the defaults are filled in, and each number has been checked by itself
void validate_target(const proto::Scenario& scenario, Checks& checks);

}  // namespace ergocast
