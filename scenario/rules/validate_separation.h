// SPDX-License-Identifier: BSD-3-Clause
// Checks whether a team can keep the distance that its scenario asks for.
#pragma once

#include <cstddef>
#include <string>

#include "core/mission/mission.h"
#include "scenario/rules/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Reports what is impossible by docs/safety.md: its conditions on speed, holding, disturbance,
/// room and starts.
/// @pre the defaults are filled in, and `scenario` has a separation
void validate_separation(const proto::Scenario& scenario, Checks& checks);

/// How far apart two bodies of one kind, among the first `bodies`, must begin [m]; "10 to 20" if
/// that depends on the kind.
std::string spacing_text(const Mission& mission, std::size_t bodies);

}  // namespace ergocast
