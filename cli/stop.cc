// SPDX-License-Identifier: BSD-3-Clause
// `ergocast stop`: ends a mission from any host on its buses, and reports whether the team obeyed.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "cli/commands.h"
#include "cli/diagnose_silence.h"
#include "cli/find_run.h"
#include "cli/report_error.h"
#include "cli/stop_request.h"
#include "cli/team_monitor.h"
#include "runtime/clock.h"
#include "runtime/node.h"
#include "runtime/signals.h"
#include "runtime/transport.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

/// Longer than any agent is silent, so that every other run on this URL is detected.
constexpr auto kLookAround = 3 * kAgentStatusPeriod / 2;
/// How long to wait for any process, and for a coordinator.
constexpr auto kListeningTime = 3s;
/// How long a coordinator may take to end the mission; then how long the team may take to exit.
constexpr auto kAnswerPatience = 5s;
constexpr auto kLongest = 15s;
/// An emergency stop is repeated at least so long, because a process may miss the first ones.
constexpr auto kLeastInsistence = 1s;
constexpr auto kStopTurn = 20ms;
/// Runs beyond kMostRuns that get a STOP in one turn.
constexpr std::size_t kMostInATurn = 256;
constexpr const char* kAtOnce = "stopped at once by `ergocast stop --now` on ";

struct StopOptions : BusOptions {
  bool at_once = false;
};

class Stopping {
 public:
  Stopping(const StopOptions& options, StopSignals& signals)
      : options_(options), signals_(signals) {}

  /// Nothing, or why LCM cannot be used.
  std::optional<std::string> open() {
    auto opened = listen_to_teams(
        options_,
        [this](const Message& message, Bus bus, AgentId transmitter) {
          hear(message, bus, transmitter);
        },
        [this](const Message& message, Bus, AgentId) { replay_ = header_of(message).run; });
    if (auto* problem = std::get_if<std::string>(&opened)) return std::move(*problem);
    transport_ = std::get<0>(std::move(opened));
    since_ = now();
    return std::nullopt;
  }

  /// Finds the run, stops it and reports the result; returns the exit code.
  int stop() {
    while (!found() && now() < since_ + kListeningTime) {
      if (!listen()) return kExitFailed;
    }
    if (runs_.size() > 1 && !options_.at_once) return choose();
    if (runs_.empty() && options_.run == 0) return nobody();
    if (options_.run != 0) runs_.try_emplace(options_.run, options_.run);
    if (!options_.at_once) transport_->set_run(runs_.begin()->first);
    since_ = now();
    return insist();
  }

 private:
  void hear(const Message& message, Bus bus, AgentId transmitter) {
    const RunId run = header_of(message).run;
    if (run == 0) return;
    if (runs_.size() < kMostRuns || runs_.contains(run)) {
      runs_.try_emplace(run, run).first->second.receive(message, bus, transmitter, now());
    } else if (crowd_.size() < kMostInATurn) {
      crowd_.insert(run);
    }
  }
  /// False if a signal came.
  bool listen() {
    transport_->deliver_until(now() + kStopTurn, signals_.fd());
    return signals_.take() == 0;
  }
  bool found() const {
    if (options_.run != 0) return true;  // the run is known, and an emergency must not wait
    return runs_.size() > 1 || (!runs_.empty() && now() >= since_ + kLookAround);
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
      if (!listen())
        return report_error(kExitFailed, "interrupted before the team was seen to end");
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
    const auto waited = now() - since_;
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

  int nobody() const {
    if (replay_ != 0) {
      return report_error(kExitFailed,
                          "what is heard on " + options_.url.base() + " is a replay of run " +
                              to_hex(replay_) +
                              ": no team flies, and there is nothing to stop. Ctrl-C ends "
                              "`ergocast replay` where it runs");
    }
    return report_error(kExitFailed, why_nobody(options_, *transport_));
  }

  int choose() const { return report_error(kExitBadInput, choice_of(runs_)); }

  const StopOptions& options_;
  StopSignals& signals_;
  std::unique_ptr<Transport> transport_;
  std::map<RunId, MonitoredRun> runs_;
  std::set<RunId> crowd_;  // beyond kMostRuns, received since the last turn
  bool crowded_ = false;
  Instant since_{};
  RunId replay_ = 0;  // of the newest message that `ergocast replay` sent; 0: none
};

int stop(const StopOptions& options) {
  if (!options.seal.can_sign()) return report_error(kExitBadInput, cannot_sign(options.key_file));
  StopSignals signals;
  Stopping stopping(options, signals);
  if (const auto problem = stopping.open()) return report_error(kExitUnavailable, *problem);
  return stopping.stop();
}

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
      return stop(*options);
    };
  });
}

}  // namespace ergocast::cli
