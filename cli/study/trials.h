// SPDX-License-Identifier: BSD-3-Clause
// `ergocast simulate --seeds`: one mission for each seed, under faults.
#pragma once

#include <string>

#include "cli/mission_options.h"

namespace ergocast::cli {

struct TrialsOptions {
  MissionOptions mission;  ///< `out` is a CSV file here; empty: none
  std::string faults;      ///< a file, "swarm", or empty: none
  Seeds seeds;
  int jobs = 1;
};

/// Runs one mission under faults for each seed; returns the program's exit code.
int trials(const TrialsOptions& options);

}  // namespace ergocast::cli
