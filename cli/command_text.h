// SPDX-License-Identifier: BSD-3-Clause
// Commands that a person can give again.
#pragma once

#include <string>
#include <vector>

#include "scenario/scenario.h"

namespace ergocast::cli {

/// The options that say `overrides`, as the words of a command; --seed is left out.
std::vector<std::string> words_of(const Overrides& overrides);

/// The options that say `overrides`, each after a space, as a shell reads them; --seed is left out.
std::string options_of(const Overrides& overrides);

}  // namespace ergocast::cli
