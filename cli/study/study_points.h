// SPDX-License-Identifier: BSD-3-Clause
// The points of a study: every scenario with every combination of the varied fields, compiled.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/study/study_directory.h"
#include "cli/study/study_options.h"
#include "core/base/result.h"
#include "scenario/scenario.h"

namespace ergocast::cli {

struct StudyPoints {
  StudyIdentity identity;
  std::vector<Scenario> scenarios;    ///< one for each point
  std::vector<std::string> laws;      ///< of each point: one in Python, FILE.py:CLASS, or empty
  std::vector<std::string> missions;  ///< the command that runs each point, without a seed
};

/// Returns the points, or all problems of all points, each once.
Result<StudyPoints, std::vector<std::string>> study_points(const StudyOptions& options);

}  // namespace ergocast::cli
