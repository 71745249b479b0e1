// SPDX-License-Identifier: BSD-3-Clause
// The scenarios that are installed with the programs, or lie in their source tree.
#pragma once

#include <CLI/CLI.hpp>

namespace ergocast {

/// For the options that take a scenario: puts the file of a shipped scenario in the place of its
/// bare name, and refuses a bare name that neither a file nor a shipped scenario has. All other
/// texts stay what they are.
CLI::Validator shipped_scenario();

}  // namespace ergocast
