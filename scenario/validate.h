// Whether a scenario can be flown.
#pragma once

#include "scenario/findings.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Reports everything in `scenario` that breaks a limit stated in scenario.proto.
/// @pre the defaults are filled in
void validate(const proto::Scenario& scenario, Findings& findings);

}  // namespace ergocast
