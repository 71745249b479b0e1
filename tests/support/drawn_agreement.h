// SPDX-License-Identifier: BSD-3-Clause
// What depends on more than one field of a drawn scenario.
#pragma once

#include "scenario/scenario.pb.h"

namespace ergocast::test {

/// Changes fields that were drawn one by one, so that most scenarios have no problem.
void agree(proto::Scenario& scenario);

}  // namespace ergocast::test
