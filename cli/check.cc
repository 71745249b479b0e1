// SPDX-License-Identifier: BSD-3-Clause
// `ergocast check`: loads a scenario, prints its warnings, and then prints either one line about it
// or its whole text with all defaults.
#include <cstdio>

#include "cli/commands.h"
#include "cli/report_error.h"
#include "cli/run_directory.h"
#include "runtime/node.h"
#include "team/plan.h"

namespace ergocast::cli {

int check(const std::filesystem::path& file, const Overrides& overrides, bool print) {
  const auto scenario = load_or_complain(file, overrides);
  if (!scenario) return kExitBadInput;
  for (const Problem& warning : scenario->warnings()) {
    tell("warning: " + to_string(warning));
  }
  if (print) {
    std::fputs(scenario->print().c_str(), stdout);
    return kExitDone;
  }
  const Mission& mission = scenario->mission();
  const std::vector<std::byte> plan = encode_plan(mission);
  std::printf(
      "%s: no problems. %zu agents, %d x %d modes, %lld ticks of %g s, plan %s (%zu bytes)\n",
      file.c_str(), mission.starts_m.size(), mission.basis.modes_x, mission.basis.modes_y,
      static_cast<long long>(mission.timing.tick_count), mission.timing.dt_s,
      plan_hash(plan).c_str(), plan.size());
  return kExitDone;
}

}  // namespace ergocast::cli
