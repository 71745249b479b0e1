// SPDX-License-Identifier: BSD-3-Clause
// `ergocast report`: reads the plan from a record and draws the report of that record again.
#include "report/report.h"

#include <cstdio>

#include "cli/commands.h"
#include "cli/recorded_team.h"
#include "cli/report_error.h"
#include "cli/run_directory.h"
#include "runtime/node.h"

namespace ergocast::cli {

int report(const std::filesystem::path& run_dir) {
  const auto mission = recorded_mission_or_complain(run_dir);
  if (!mission) return kExitBadInput;
  if (const auto problem = write_report(run_dir, *mission, recorded_team(run_dir, *mission))) {
    return report_error(kExitBadInput, *problem);
  }
  std::printf("%s\n", (std::filesystem::absolute(run_dir) / "report.html").c_str());
  return kExitDone;
}

}  // namespace ergocast::cli
