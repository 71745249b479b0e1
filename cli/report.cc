// SPDX-License-Identifier: BSD-3-Clause
// `ergocast report`: reads the plan from a record and draws the report of that record again.
#include "report/report.h"

#include <cstdio>
#include <memory>

#include "cli/commands.h"
#include "cli/mission_options.h"
#include "cli/recorded_team.h"
#include "cli/report_error.h"
#include "cli/run_directory.h"
#include "runtime/node.h"
#include "text/printable.h"

namespace ergocast::cli {
namespace {

int report(const std::filesystem::path& run_dir) {
  const auto mission = recorded_mission_or_complain(run_dir);
  if (!mission) return kExitBadInput;
  std::string log_problem;
  const auto team = recorded_team(run_dir, *mission, &log_problem);
  if (const auto problem = write_report(run_dir, *mission, team))
    return report_error(kExitBadInput, *problem);
  if (!log_problem.empty()) {
    std::fprintf(stderr, "the report lacks the rest of the event log: %s\n",
                 printable(log_problem).c_str());
  }
  std::printf("%s\n", (std::filesystem::absolute(run_dir) / "report.html").c_str());
  return kExitDone;
}

}  // namespace

void add_report(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("report", "Make a run's report again");
  auto run_dir = std::make_shared<std::filesystem::path>();
  add_run_dir_argument(*command, *run_dir);
  command->callback([&action, run_dir] { action = [run_dir] { return report(*run_dir); }; });
}

}  // namespace ergocast::cli
