// SPDX-License-Identifier: BSD-3-Clause
// A mission as text for people.
#pragma once

#include <string>

#include "core/mission/mission.h"

namespace ergocast {

/// The scenario's text of `mission`, all fields with their values. It lacks the description and the
/// target, because a mission has only μ. With a target added it reads back to this mission, except
/// for μ and wait_for_logger.
/// @pre within_limits(mission), plan/mission_limits.h
std::string mission_text(const Mission& mission);

}  // namespace ergocast
