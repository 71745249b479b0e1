// SPDX-License-Identifier: BSD-3-Clause
// `ergocast recall`: sends agents home, or out of the mission.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/launch/team_command.h"
#include "cli/operate/recall_order.h"
#include "cli/watch/find_run.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

/// How long to wait for the whole mission; agents of a large team send it in turn.
constexpr auto kMissionPatience = 20s;

class Recalling : public TeamCommand {
 public:
  Recalling(const BusOptions& options, const std::vector<AgentId>& agents, bool leaves)
      : TeamCommand(options), agents_(agents), leaves_(leaves) {}

 private:
  int act() override {
    if (!look_around()) return interrupted();
    if (runs_.empty()) return nobody();
    if (runs_.size() > 1) return choose();
    transport_->set_run(team().run());
    while (!team().is_running() && !team().over() && waited() < kMissionPatience) {
      if (!listen()) return interrupted();
    }
    if (!team().is_running()) return refused();
    // No agent is recalled if any of them cannot be.
    std::vector<RecallOrder> orders;
    for (const AgentId id : agents_) {
      orders.emplace_back(id, leaves_, now());
      const std::string why = orders.back().why_impossible(team());
      if (!why.empty()) return report_error(kExitFailed, why);
    }
    return carry_out_all(std::move(orders));
  }

  const MonitoredRun& team() const { return runs_.begin()->second; }

  int carry_out_all(std::vector<RecallOrder> orders) {
    int code = kExitDone;
    while (!orders.empty()) {
      std::erase_if(orders, [&](RecallOrder& order) {
        const OrderProgress progress = order.advance(team(), *transport_, now());
        if (progress.state == OrderProgress::State::kFailed)
          code = report_error(kExitFailed, progress.text);
        if (progress.state == OrderProgress::State::kDone) {
          std::printf("%s\n", progress.text.c_str());
          std::fflush(stdout);
        }
        return progress.state != OrderProgress::State::kUnderWay;
      });
      if (!orders.empty() && !listen()) return interrupted();
    }
    return code;
  }

  int refused() const {
    return report_error(
        kExitFailed,
        team().over() ? "the mission is over: " + team().reason()
        : team().knows_mission()
            ? "the mission has not begun: it waits for its quorum, and no vehicle moves"
            : "the mission was not received: is its coordinator running?");
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
