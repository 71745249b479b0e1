// SPDX-License-Identifier: BSD-3-Clause
// ergocast: lists the commands and runs the one that the command line selects.
#include "cli/commands.h"
#include "cli/report_error.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {
namespace {

constexpr const char* kExitCodes =
    "Exit codes: 0 done; 1 verify, status or doctor found something; 2 bad scenario, arguments or\n"
    "run directory; 3 LCM cannot be used on this machine; 4 the mission failed or its record "
    "broke\n"
    "off, some of many missions failed, or stop, pause, resume, amend or recall did not see the\n"
    "team obey.";

/// In the order of --help.
constexpr void (*kCommands[])(CLI::App&, Action&) = {
    add_run,    add_simulate, add_study,  add_bench,  add_new,   add_check,
    add_report, add_verify,   add_keygen, add_deploy, add_list,  add_status,
    add_watch,  add_run_page, add_export, add_replay, add_pause, add_amend,
    add_recall, add_stop,     add_spy,    add_doctor};

int parse_and_do(int argc, char** argv) {
  CLI::App app("Ergocast: teams of robots that spread their time over a region as a map demands.",
               "ergocast");
  app.require_subcommand(1);
  app.set_version_flag("--version", version_text());
  Action action;
  for (const auto add : kCommands) add(app, action);
  app.footer(kExitCodes);  // last: commands added after it would show it as their own footer
  for (CLI::App* command : app.get_subcommands({})) {
    command->set_version_flag("--version", version_text());
  }
  if (const int code = parse_command_line(app, argc, argv); code >= 0) return code;
  return action();
}

}  // namespace
}  // namespace ergocast::cli

int main(int argc, char** argv) {
  try {
    return ergocast::cli::parse_and_do(argc, argv);
  } catch (const std::exception& error) {
    ergocast::cli::print_message(std::string("ergocast: ") + error.what());
    return ergocast::kExitFailed;
  }
}
