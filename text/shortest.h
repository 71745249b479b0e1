// SPDX-License-Identifier: BSD-3-Clause
// Formats numbers as people write them.
#pragma once

#include <string>

namespace ergocast {

/// The fewest digits that read back as `value`; without an exponent where that is easy to read.
std::string shortest(double value);

}  // namespace ergocast
