// SPDX-License-Identifier: BSD-3-Clause
// `ergocast report`: reads the plan from a record, makes the page of that record again, and lets
// Python draw the figures.
#include "report/report.h"

#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/debian_python.h"
#include "cli/mission_options.h"
#include "cli/record/run_directory.h"
#include "cli/report_error.h"
#include "cli/team/recorded_team.h"
#include "runtime/process/program_options.h"
#include "text/printable.h"

namespace ergocast::cli {
namespace {

int report(const std::filesystem::path& run_dir, bool figures) {
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
  if (!figures) return kExitDone;
  return become_python("ergocast.plot", {run_dir}, "no figures: they need");
}

}  // namespace

void add_report(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("report", "Make a run's report again");
  struct Options {
    std::filesystem::path run_dir;
    bool figures = false;
  };
  auto options = std::make_shared<Options>();
  add_run_dir_argument(*command, options->run_dir);
  command->add_flag("--figures", options->figures,
                    "Also draw DIR/figures/*.svg and *.pdf; needs python3-ergocast and "
                    "python3-matplotlib");
  command->callback([&action, options] {
    action = [options] { return report(options->run_dir, options->figures); };
  });
}

}  // namespace ergocast::cli
