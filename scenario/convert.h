// SPDX-License-Identifier: BSD-3-Clause
// From Protobuf's blocks to the cores' plain types. Defaults are filled in; nothing is checked.
#pragma once

#include "core/mission.h"
#include "target/target.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

Box domain_of(const proto::Domain& domain);
Polygon polygon_of(const proto::Polygon& polygon);
/// The whole target but for its maps.
TargetDensity target_of(const proto::Target& target);
/// Where the scenario says that the map lies.
Rectangle extent_of(const proto::Map& map);
Basis basis_of(const proto::Basis& basis);
ControlLaw law_of(const proto::Law& law, const Box& domain);
Timing timing_of(const proto::Time& time);

/// The whole mission but for μ.
Mission mission_of(const proto::Scenario& scenario);

}  // namespace ergocast
