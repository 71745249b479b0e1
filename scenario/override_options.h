// SPDX-License-Identifier: BSD-3-Clause
// The command-line options that override fields of a scenario file.
#pragma once

#include <CLI/CLI.hpp>

#include "scenario/scenario.h"

namespace ergocast {

/// --seed, --duration, --agents, --lockstep and --realtime.
void add_override_options(CLI::App& command, Overrides& overrides);

}  // namespace ergocast
