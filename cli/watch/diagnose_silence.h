// SPDX-License-Identifier: BSD-3-Clause
// Explains why a command that listens to a team receives nothing.
#pragma once

#include <string>

#include "runtime/bus/transport.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {

/// One sentence with the remedy: wrong URL or network, another version, another key or none.
std::string why_nobody(const BusOptions& options, const Transport& transport);

}  // namespace ergocast::cli
