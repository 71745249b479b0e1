// SPDX-License-Identifier: BSD-3-Clause
// Sets one field of a scenario by its path.
#pragma once

#include "scenario/parse/findings.h"
#include "scenario/parse/source.h"
#include "scenario/scenario.pb.h"

namespace ergocast {

/// Writes `field` into `scenario`. Reports an error if the path names no number, word or truth
/// value, if the value cannot be read, or if another flag has already set the field. From now on
/// all problems of the field are reported for `field.flag`.
void assign(const FieldValue& field, proto::Scenario& scenario, Findings& findings);

}  // namespace ergocast
