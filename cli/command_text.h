// SPDX-License-Identifier: BSD-3-Clause
// Command lines that a person can run again.
#pragma once

#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace ergocast::cli {

/// `overrides` as the options of a command, one word each; --seed is left out.
std::vector<std::string> words_of(const Overrides& overrides);

/// `overrides` as options for a shell, each after a space; --seed is left out.
std::string options_of(const Overrides& overrides);

}  // namespace ergocast::cli
