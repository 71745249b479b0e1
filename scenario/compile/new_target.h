// SPDX-License-Identifier: BSD-3-Clause
// Turns a target for a running mission into a scenario of that mission.
#pragma once

#include <string>

#include "scenario/parse/findings.h"
#include "scenario/parse/source.h"
#include "scenario/rules/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Makes a scenario of a file that is a target by itself: a map, GeoJSON or a drawing. A map
/// without an extent of its own covers the domain. False if the file's name is not one of those; a
/// name that can only be meant so is reported.
bool read_target_file(const std::string& file, const proto::Domain& domain,
                      proto::Scenario& scenario, Findings& findings);

/// Reports command-line values for other fields than those of the target.
void refuse_other_fields(const Overrides& overrides, Findings& findings);

/// Gives `scenario` the running mission's domain, and its origin if it has none. Reports a domain
/// or an origin that is not the running mission's.
void place_in(const proto::Scenario& running, proto::Scenario& scenario, Checks& checks);

/// Replaces all but the target by what the running mission has. A solid keep-out becomes a
/// plain one, because it is among the running mission's walls. Reports walls that are not.
/// @pre polygons of files were read, place_in()
void complete_from(const proto::Scenario& running, proto::Scenario& scenario, Checks& checks);

}  // namespace ergocast
