// SPDX-License-Identifier: BSD-3-Clause
// Reads Protobuf's text format with helpful errors, and prints it for people.
#pragma once

#include <string>
#include <string_view>

#include "scenario/parse/findings.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Reads `text` into `scenario`, records the place of each field, and reports all format errors. A
/// field that cannot be read is skipped, and the rest is read.
/// @return false if the text cannot be read: `scenario` is then unusable
bool read_text(std::string_view text, proto::Scenario& scenario, Findings& findings);

/// Every set field. Doubles in the fewest digits that read back exactly; a start or vertex takes
/// one line.
std::string print_text(const proto::Scenario& scenario);

}  // namespace ergocast
