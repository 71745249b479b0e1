// SPDX-License-Identifier: BSD-3-Clause
// What has changed in a recorded mission, in lines for people.
#pragma once

#include <string>
#include <vector>

#include "core/mission/mission.h"
#include "logger/run_data.h"

namespace ergocast::cli {

/// A line for each target, end, law and zone of a record, in the order of their numbers: when it
/// held, and for a zone which agents were inside at the tick from which it is free.
/// @param run  its tracks are only needed for zones
std::vector<std::string> amendment_lines(const RunData& run, const Mission& mission);

}  // namespace ergocast::cli
