// SPDX-License-Identifier: BSD-3-Clause
// Protobuf's text format, read with useful complaints and printed to be read.
#pragma once

#include <string>
#include <string_view>

#include "scenario/findings.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Reads `text` into `scenario`, records where each field stands, and reports everything that the
/// format itself refuses. A field that cannot be read is given up, and the rest is read.
/// @return false where that cannot be done: `scenario` is then of no use
bool read_text(std::string_view text, proto::Scenario& scenario, Findings& findings);

/// Every set field. Doubles in the fewest digits that read back exactly; a start or vertex takes one line.
std::string print_text(const proto::Scenario& scenario);

}  // namespace ergocast
