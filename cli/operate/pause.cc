// SPDX-License-Identifier: BSD-3-Clause
// `ergocast pause` and `ergocast resume`: stop a team for a while and continue.
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/operate/pause_order.h"
#include "cli/operate/team_command.h"
#include "cli/watch/find_run.h"

namespace ergocast::cli {
namespace {

class Pausing : public TeamCommand {
 public:
  Pausing(const BusOptions& options, bool pauses) : TeamCommand(options), pauses_(pauses) {}

 private:
  int act() override {
    if (const auto code = choose_run()) return *code;
    PauseOrder order(pauses_, now(), own_operator_name());
    const auto report = obeyed(order);
    if (!report) return interrupted();
    if (report->state == OrderReport::State::kFailed)
      return report_error(kExitFailed, report->text);
    std::printf("%s\n", report->text.c_str());
    if (pauses_) std::printf("`ergocast resume` continues the mission\n");
    return kExitDone;
  }

  const bool pauses_;
};

void add(CLI::App& app, Action& action, bool pause) {
  auto* command = pause ? app.add_subcommand("pause", "Pause a mission")
                        : app.add_subcommand("resume", "Resume a paused mission");
  auto options = std::make_shared<BusOptions>();
  add_bus_options(*command, *options);
  describe_search(*command);
  command->footer(
      std::string(pause ? "From a tick that the coordinator names, vehicles brake, then "
                          "stand or loiter. Mission\n"
                          "time stops: coverage does not count, and the mission ends so "
                          "much later.\n"
                        : "All agents resume at the same tick, which the coordinator names.\n") +
      "Exit codes: 0 the team has obeyed; 2 several runs are found; 3 LCM cannot be "
      "used; 4 no\n"
      "team is found, or it was not seen to obey.");
  command->callback([&action, options, command, pause] {
    action = [options, command, pause] {
      if (const auto code = find_run(*command, *options)) return *code;
      return Pausing(*options, pause).carry_out();
    };
  });
}

}  // namespace

void add_pause(CLI::App& app, Action& action) {
  add(app, action, true);
  add(app, action, false);
}

}  // namespace ergocast::cli
