// SPDX-License-Identifier: BSD-3-Clause
// `ergocast recall`: sends agents home, or out of the mission.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/operate/recall_order.h"
#include "cli/operate/team_command.h"
#include "cli/watch/find_run.h"

namespace ergocast::cli {
namespace {

class Recalling : public TeamCommand {
 public:
  Recalling(const BusOptions& options, const std::vector<AgentId>& agents, bool leaves)
      : TeamCommand(options), agents_(agents), leaves_(leaves) {}

 private:
  int act() override {
    if (const auto code = choose_run()) return *code;
    const MonitoredRun& team = runs_.begin()->second;
    while (!team.is_running()) {
      const OrderReport report = waiting_for_mission(team, waited());
      if (report.state == OrderReport::State::kFailed)
        return report_error(kExitFailed, report.text);
      if (!listen()) return interrupted();
    }
    // No agent is recalled if any of them cannot be.
    std::vector<RecallOrder> orders;
    for (const AgentId id : agents_) {
      const RecallOrder& order = orders.emplace_back(id, leaves_, now());
      if (const auto why = order.why_impossible(team)) return report_error(kExitFailed, *why);
    }
    return carry_out_all(orders);
  }

  /// Gives all orders at the same time; returns the exit code.
  int carry_out_all(std::vector<RecallOrder>& orders) {
    const MonitoredRun& team = runs_.begin()->second;
    int code = kExitDone;
    while (!orders.empty()) {
      Outbox out;
      for (RecallOrder& order : orders) order.send(team, now(), out);
      transport_->publish(out);
      std::erase_if(orders, [&](const RecallOrder& order) {
        const OrderReport report = order.report(team, now());
        if (report.state < OrderReport::State::kObeyed) return false;
        if (report.state == OrderReport::State::kFailed) {
          code = report_error(kExitFailed, report.text);
        } else {
          std::printf("%s\n", report.text.c_str());
          std::fflush(stdout);
        }
        return true;
      });
      if (!orders.empty() && !listen()) return interrupted();
    }
    return code;
  }

  const std::vector<AgentId>& agents_;
  const bool leaves_;
};

}  // namespace

void add_recall(CLI::App& app, Action& action) {
  struct Options : BusOptions {
    std::vector<AgentId> agents;
    bool leaves = false;
  };
  auto* command = app.add_subcommand("recall", "Send agents home, or out of the mission");
  auto options = std::make_shared<Options>();
  command->add_option("AGENT", options->agents, "Numbers of the agents")
      ->required()
      ->check(CLI::Range(0, kMaxAgents - 1).description(""))
      ->type_name("N");
  command->add_flag(
      "--leave", options->leaves,
      "Send them out of the mission: each stops where it is, its process ends, and no "
      "other agent gets its number");
  add_bus_options(*command, *options);
  describe_search(*command);
  command->footer(
      "A recalled agent goes to its station, or to where it began, and rests there: it covers and\n"
      "broadcasts no more. What it has covered counts. It does not come back in this mission.\n"
      "Exit codes: 0 the team has obeyed; 2 several runs are found; 3 LCM cannot be used; 4 no\n"
      "team or no such agent is found, or the team was not seen to obey.");
  command->callback([&action, options, command] {
    action = [options, command] {
      if (const auto code = find_run(*command, *options)) return *code;
      return Recalling(*options, options->agents, options->leaves).carry_out();
    };
  });
}

}  // namespace ergocast::cli
