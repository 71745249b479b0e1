// SPDX-License-Identifier: BSD-3-Clause
// What missions that steer by the modes of their free domain may not have.
#pragma once

#include "scenario/rules/checks.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Reports what cannot be combined with basis.free_domain.
void validate_free_domain(const proto::Scenario& scenario, Checks& checks);

}  // namespace ergocast
