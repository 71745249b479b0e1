// SPDX-License-Identifier: BSD-3-Clause
// The scenarios that are installed with the programs, or are in their source tree.
#pragma once

#include <CLI/CLI.hpp>

namespace ergocast {

/// For options that take a scenario: replaces the bare name of a shipped scenario by its file. A
/// bare name without a file or shipped scenario is refused. All other texts stay unchanged.
CLI::Validator shipped_scenario();

}  // namespace ergocast
