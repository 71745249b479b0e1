// SPDX-License-Identifier: BSD-3-Clause
// Commands that a person can give again.
#pragma once

#include <string>

#include "scenario/scenario.h"

namespace ergocast::cli {

/// The options that say `overrides`, each after a space, as a shell reads them; --seed is left out.
std::string options_of(const Overrides& overrides);

}  // namespace ergocast::cli
