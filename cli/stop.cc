// SPDX-License-Identifier: BSD-3-Clause
// `ergocast stop`: ends a mission from any host on its buses, and reports whether the team obeyed.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "cli/commands.h"
#include "cli/find_run.h"
#include "cli/stop_request.h"
#include "cli/team_command.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

/// How long the team may take to exit.
constexpr auto kLongest = 15s;
/// An emergency stop is repeated at least so long, because a process may miss the first ones.
constexpr auto kLeastInsistence = 1s;
constexpr const char* kAtOnce = "stopped at once by `ergocast stop --now` on ";

struct StopOptions : BusOptions {
  bool at_once = false;
};

class Stopping : public TeamCommand {
 public:
  explicit Stopping(const StopOptions& options) : TeamCommand(options), options_(options) {}

 private:
  int act() override {
    // A run that is named is known, and an emergency must not wait.
    if (options_.run == 0 && !look_around()) return interrupted();
    if (runs_.size() > 1 && !options_.at_once) return choose();
    if (runs_.empty() && options_.run == 0) return nobody();
    if (options_.run != 0) runs_.try_emplace(options_.run, options_.run);
    if (!options_.at_once) transport_->set_run(runs_.begin()->first);
    since_ = now();
    return insist();
  }

  /// Stops the selected run. In an emergency it stops all runs on the URL, also those received
  /// later, because there is no time to choose.
  int insist() {
    std::map<RunId, StopRequest> words;
    std::map<RunId, int> codes;
    do {
      for (const auto& [run, team] : runs_) {
        if (!codes.contains(run)) say(run, team, words);
      }
      say_to_the_crowd();
      if (!listen()) return interrupted();
      for (const auto& [run, word] : words) {
        if (codes.contains(run)) continue;
        if (const auto code = verdict(runs_.at(run))) codes[run] = *code;
      }
    } while (codes.size() < runs_.size());
    if (crowded_) {
      return report_error(kExitFailed,
                          "more than " + std::to_string(kMostRuns) +
                              " runs were heard, recordings of former ones perhaps; all "
                              "were told, but not all were seen to obey: say it again "
                              "with --run-id");
    }
    return std::max_element(codes.begin(), codes.end(),
                            [](const auto& a, const auto& b) { return a.second < b.second; })
        ->second;
  }

  /// Runs beyond kMostRuns must stop, too. Other runs, or recordings of them, may fill the table.
  void say_to_the_crowd() {
    if (!options_.at_once) return;
    for (const RunId run : crowd_) {
      StopRequest(run, false, kAtOnce + host_name()).repeat(*transport_, now(), true);
    }
    crowded_ = crowded_ || !crowd_.empty();
    crowd_.clear();
  }

  void say(RunId run, const MonitoredRun& team, std::map<RunId, StopRequest>& words) {
    const char* how = options_.at_once ? kAtOnce : "stopped by `ergocast stop` on ";
    const auto [word, is_new] = words.try_emplace(run, run, false, how + host_name());
    if (is_new) {
      std::printf("run %s: %s\n", to_hex(run).c_str(),
                  options_.at_once ? "telling everybody to stand still"
                                   : "asking the coordinator to end the mission");
      std::fflush(stdout);
    }
    if (options_.at_once || !team.over()) {
      word->second.repeat(*transport_, now(), options_.at_once);
    }
  }

  /// The exit code, or nothing while it is unknown.
  std::optional<int> verdict(const MonitoredRun& team) const {
    const auto waited = this->waited();
    const auto left = team.still_there(now());
    const bool obeyed = options_.at_once ? waited >= kLeastInsistence : team.over();
    if (team.unheard()) return waited < kListeningTime ? std::nullopt : std::optional(nobody());
    if (obeyed && left.empty()) return conclude(team);
    if (waited >= kLongest) {
      return report_error(kExitFailed,
                          "still heard: " + listed(left) +
                              (options_.at_once ? ": end them on their hosts"
                                                : ": ergocast stop --now stops them at once"));
    }
    if (obeyed || options_.at_once) return std::nullopt;
    if (!team.coordinator_heard() && waited >= kListeningTime) {
      return report_error(kExitFailed,
                          "no coordinator is heard, and nobody else ends a mission in order: "
                          "ergocast stop --now stops the team at once");
    }
    if (waited >= kAnswerPatience) {
      return report_error(kExitFailed,
                          "the coordinator does not end the mission: ergocast stop --now stops "
                          "the team at once");
    }
    return std::nullopt;
  }

  int conclude(const MonitoredRun& team) const {
    // A mission that never started has moved no vehicle.
    if (options_.at_once && !team.world_heard() && team.tick() > 0) {
      return report_error(kExitFailed,
                          "nobody is heard any more, but no world or driver was heard "
                          "before either: whether the vehicles stand still is not known: "
                          "look at them");
    }
    if (options_.at_once && !team.stands_still()) {
      return report_error(kExitFailed, "the world is silent, and in its last state, of tick " +
                                           std::to_string(team.tick()) +
                                           ", vehicles still move: look at them");
    }
    const auto lost = team.lost(now());
    const std::string but = lost.empty() ? "" : "; " + listed(lost) + " did not say so";
    std::printf("%s at tick %lld: %s%s\n", options_.at_once ? "stopped" : "the mission has ended",
                static_cast<long long>(team.tick()),
                options_.at_once ? "all stand still and have ended" : team.reason().c_str(),
                but.c_str());
    return kExitDone;
  }

  const StopOptions& options_;
  bool crowded_ = false;
};

}  // namespace

void add_stop(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("stop", "End a mission that is flying, in order or at once");
  auto options = std::make_shared<StopOptions>();
  add_bus_options(*command, *options);
  command->add_flag(
      "--now", options->at_once,
      "Emergency: agents and world stand still within a tick, also without a coordinator");
  command->footer(
      "Without --now the coordinator ends the mission for all. With --now all runs that are heard\n"
      "stop; with --run-id besides, it listens for nobody first.\n"
      "Exit codes: 0 the team was seen to end; 2 several runs are heard; 3 LCM cannot be used;\n"
      "4 nobody is heard, somebody goes on, or what the vehicles do is not known.");
  command->callback([&action, options, command] {
    action = [options, command] {
      if (const auto code = find_run(*command, *options)) return *code;
      return Stopping(*options).carry_out();
    };
  });
}

}  // namespace ergocast::cli
