// SPDX-License-Identifier: BSD-3-Clause
// A picture of where a scenario's agents can be.
#pragma once

#include <string>

#include "scenario/scenario.h"

namespace ergocast::cli {

/// An SVG of the domain with its walls in grey and the starts as discs. What maps show as free but
/// no body can reach is hatched.
std::string picture_of(const Scenario& scenario);

}  // namespace ergocast::cli
