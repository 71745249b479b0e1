// SPDX-License-Identifier: BSD-3-Clause
// `ergocast simulate --seeds`: runs one mission for each seed, under faults.
#pragma once

#include <string>

#include "cli/mission_options.h"

namespace ergocast::cli {

struct TrialsOptions {
  MissionOptions mission;  ///< here `out` names a CSV file; empty: none
  std::string faults;      ///< a file, "swarm", or empty: none
  Seeds seeds;
  int jobs = 1;
};

/// Runs one mission under faults for each seed; returns the program's exit code.
int trials(const TrialsOptions& options);

}  // namespace ergocast::cli
