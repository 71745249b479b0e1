// SPDX-License-Identifier: BSD-3-Clause
// A mission as people read it.
#pragma once

#include <string>

#include "core/mission.h"

namespace ergocast {

/// The scenario's text of `mission`, all fields with their values, but without the target, of which
/// a mission knows only μ, and without description. With a target added it reads back to this
/// mission, but for μ and wait_for_logger.
/// @pre within_limits(mission), core/mission_limits.h
std::string mission_text(const Mission& mission);

}  // namespace ergocast
