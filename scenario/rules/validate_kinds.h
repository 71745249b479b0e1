// SPDX-License-Identifier: BSD-3-Clause
// The rules of agents { kind }.
#pragma once

#include <string>

#include "scenario/rules/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// The field that has a kind's footprint: its own, or that of all agents.
std::string footprint_path(const proto::Agents& agents, int kind);

/// Reports kinds without a name or with the name of another kind, counts that do not add up to the
/// team, speeds and noise that the law could not have, footprints larger than the domain, and bands
/// without a mode.
/// @pre each number was checked against its limits
void validate_kinds(const proto::Scenario& scenario, Checks& checks);

}  // namespace ergocast
