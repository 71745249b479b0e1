// SPDX-License-Identifier: BSD-3-Clause
// Converts Protobuf's blocks to the plain types of the cores. Defaults are filled in; nothing is
// checked.
#pragma once

#include "core/mission/mission.h"
#include "scenario/scenario.pb.h"
#include "target/rectangle.h"
#include "target/target.h"

namespace ergocast {

Box domain_of(const proto::Domain& domain);
Polygon polygon_of(const proto::Polygon& polygon);
/// The whole target, except its maps.
TargetDensity target_of(const proto::Scenario& scenario);
/// The extent of the map that the scenario states.
Rectangle extent_of(const proto::Map& map);
Basis basis_of(const proto::Basis& basis);
/// The place that the contraction of `law` pulls to.
Eigen::Vector3d contraction_center_of(const proto::Law& law, const Box& domain);

/// How many agents the team may have.
int most_agents(const proto::Scenario& scenario);

/// Whether anything is solid: a wall, or a keep-out.
bool has_walls(const proto::Scenario& scenario);

/// The solid keep-outs become the last of the walls, which mean the same.
void make_walls(proto::Scenario& scenario);

/// The whole mission, except μ.
Mission mission_of(const proto::Scenario& scenario);

}  // namespace ergocast
