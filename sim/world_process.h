// SPDX-License-Identifier: BSD-3-Clause
// A world as a process, whatever moves its bodies.
#pragma once

#include "runtime/process/program_options.h"
#include "sim/physics.h"

namespace ergocast {

/// Takes part in a mission until it is over, or a signal ends it. Returns the exit code.
/// @param physics  what moves the bodies; without it core/motion/vehicle.h does
int run_world(const NodeOptions& node, PhysicsMaker physics = {});

}  // namespace ergocast
