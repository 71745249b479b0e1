// SPDX-License-Identifier: BSD-3-Clause
// Setting one field of a scenario by its path.
#pragma once

#include "scenario/findings.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Writes `field` into `scenario`. A path that names no number, word or truth value, or a value
/// that cannot be read, is reported; from now on all problems of the field are those of
/// `field.flag`.
void assign(const FieldValue& field, proto::Scenario& scenario, Findings& findings);

}  // namespace ergocast
