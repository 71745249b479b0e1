// SPDX-License-Identifier: BSD-3-Clause
// `ergocast pause` and `ergocast resume`: stop a team for a while and continue.
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
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
  using State = OrderReport::State;
  /// How long none of the vehicles that still move may get slower.
  static constexpr std::chrono::seconds kPatience{20};
  /// How often the vehicles that still move are named.
  static constexpr std::chrono::seconds kShowPeriod{2};

  int act() override {
    if (const auto code = choose_run()) return *code;
    PauseOrder order(pauses_, now(), own_operator_name());
    auto report = obeyed(order);
    if (report && report->state == State::kObeyed) report = stand(order);
    if (!report) return interrupted();
    if (report->state == OrderReport::State::kFailed)
      return report_error(kExitFailed, report->text);
    std::printf("%s\n", report->text.c_str());
    if (pauses_) std::printf("`ergocast resume` continues the mission\n");
    return kExitDone;
  }

  /// Waits until no vehicle moves, and prints which ones still do.
  std::optional<OrderReport> stand(PauseOrder& order) {
    BrakingWatch braking(kPatience / kTurnTime);
    std::string shown;
    for (int turns = 1;; ++turns) {
      const OrderReport report = turn(order);
      if (report.state != State::kObeyed) return report;
      if (braking.is_stuck(runs_.begin()->second.standing()))
        return OrderReport{State::kFailed, report.text + ", and none of them has slowed down for " +
                                               std::to_string(kPatience.count()) + " s"};
      if (turns % (kShowPeriod / kTurnTime) == 0 && report.text != shown) {
        shown = report.text;
        std::printf("%s\n", shown.c_str());
        std::fflush(stdout);
      }
      if (!listen()) return std::nullopt;
    }
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
      pause
          ? "From a tick that the coordinator names, vehicles brake, then stand or loiter. "
            "Mission\n"
            "time stops: coverage does not count, and the mission ends so much later.\n"
            "Exit codes: 0 all vehicles stand or loiter; 2 several runs are found; 3 LCM cannot be "
            "used;\n"
            "4 no team is found, it was not seen to obey, or a vehicle does not slow down."
          : "All agents resume at the same tick, which the coordinator names.\n"
            "Exit codes: 0 the mission goes on; 2 several runs are found; 3 LCM cannot be used; 4 "
            "no\n"
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
