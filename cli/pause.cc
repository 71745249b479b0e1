// SPDX-License-Identifier: BSD-3-Clause
// `ergocast pause` and `ergocast resume`: a team stands for a while, and goes on.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "cli/commands.h"
#include "cli/diagnose_silence.h"
#include "cli/find_run.h"
#include "cli/report_error.h"
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
/// How long to wait for any process; for the whole mission, which a large team says in turn.
constexpr auto kListeningTime = 3s;
constexpr auto kMissionPatience = 20s;
/// How long a coordinator may take to name a tick, and the team to reach it.
constexpr auto kAnswerPatience = 5s;
constexpr auto kPeriod = 100ms;

class Pausing {
 public:
  Pausing(const BusOptions& options, bool pauses, StopSignals& signals)
      : options_(options), pauses_(pauses), signals_(signals) {}

  /// Nothing, or why LCM cannot be used.
  std::optional<std::string> open() {
    auto opened = listen_to_teams(
        options_,
        [this](const Message& message, Bus bus, AgentId transmitter) {
          hear(message, bus, transmitter);
        },
        [](const Message&, Bus, AgentId) {});
    if (auto* problem = std::get_if<std::string>(&opened)) return std::move(*problem);
    transport_ = std::get<0>(std::move(opened));
    since_ = now();
    return std::nullopt;
  }

  /// Finds the run, asks its coordinator and reports the result; returns the exit code.
  int ask() {
    while (!found()) {
      if (!listen()) return interrupted();
      if (runs_.empty() && now() - since_ >= kListeningTime)
        return report_error(kExitFailed, why_nobody(options_, *transport_));
    }
    if (runs_.size() > 1) return report_error(kExitBadInput, choice_of(runs_));
    transport_->set_run(team().run());
    while (!team().flies() && !team().over() && now() - since_ < kMissionPatience) {
      if (!listen()) return interrupted();
    }
    if (!team().flies()) return refused();
    changes_ = named_changes(team().holds());
    since_ = now();
    return is_done() ? there_already() : insist();
  }

 private:
  void hear(const Message& message, Bus bus, AgentId transmitter) {
    const RunId run = header_of(message).run;
    const bool wanted = run != 0 && (options_.run == 0 || run == options_.run);
    if (!wanted || (runs_.size() >= kMostRuns && !runs_.contains(run))) return;
    runs_.try_emplace(run, run).first->second.receive(message, bus, transmitter, now());
  }
  const MonitoredRun& team() const { return runs_.begin()->second; }
  /// False if a signal came.
  bool listen() {
    transport_->deliver_until(now() + kPeriod / 5, signals_.fd());
    return signals_.take() == 0;
  }
  bool found() const {
    const bool one = options_.run != 0 || now() - since_ >= kLookAround;
    return runs_.size() > 1 || (!runs_.empty() && one);
  }
  /// Whether the tick is named.
  bool is_done() const { return is_open(team().holds()) == pauses_; }
  Tick named() const {
    const Hold& last = team().holds().back();
    return pauses_ ? last.from : last.until;
  }

  int insist() {
    while (!is_done() || team().tick() < named()) {
      if (!is_done()) say();
      if (!listen()) return interrupted();
      if (team().over())
        return report_error(kExitFailed, "the mission has ended before: " + team().reason());
      if (!is_done() && now() - since_ >= kAnswerPatience)
        return report_error(kExitFailed, why_not());
    }
    std::printf(pauses_ ? "paused from tick %lld on: `ergocast resume` lets the mission go on\n"
                        : "the mission goes on from tick %lld on\n",
                static_cast<long long>(named()));
    return kExitDone;
  }

  void say() {
    if (now() < next_) return;
    next_ = now() + kPeriod;
    ++header_.sequence;
    header_.run = team().run();
    transport_->publish({Bus::kSwarm, Pause{header_, changes_, {}}});
  }

  int there_already() const {
    if (pauses_) {
      std::printf("the mission is paused already, from tick %lld on\n",
                  static_cast<long long>(named()));
    } else {
      std::printf("the mission is not paused\n");
    }
    return kExitDone;
  }
  int interrupted() const {
    return report_error(kExitFailed, "interrupted before the team was seen to obey");
  }
  int refused() const {
    return report_error(kExitFailed,
                        team().over() ? "the mission is over: " + team().reason()
                        : team().knows_mission()
                            ? "the mission has not begun: it waits for its quorum, and nobody moves"
                            : "the mission was not heard: is its coordinator running?");
  }
  std::string why_not() const {
    if (!team().coordinator_heard())
      return "no coordinator is heard, and nobody else names a tick: start one with "
             "ergocast-coordinator --resume, or end the mission with ergocast stop --now";
    if (team().holds().size() == kMaxHolds && pauses_)
      return "a mission can be paused " + std::to_string(kMaxHolds) + " times, and it was";
    return "the coordinator names no tick: it may have another key, or hear no world";
  }

  const BusOptions& options_;
  const bool pauses_;
  StopSignals& signals_;
  std::unique_ptr<Transport> transport_;
  std::map<RunId, MonitoredRun> runs_;
  Header header_{0, kOperator, random_identity(), 0, 0};
  std::int32_t changes_ = 0;  // as the team had made when it was heard first
  Instant since_{}, next_{};
};

int ask_for(bool pause, const BusOptions& options) {
  if (!options.seal.can_sign()) return report_error(kExitBadInput, cannot_sign(options.key_file));
  StopSignals signals;
  Pausing pausing(options, pause, signals);
  if (const auto problem = pausing.open()) return report_error(kExitUnavailable, *problem);
  return pausing.ask();
}

void add(CLI::App& app, Action& action, bool pause) {
  auto* command = pause ? app.add_subcommand("pause", "Let a mission stand still for a while")
                        : app.add_subcommand("resume", "Let a paused mission go on");
  auto options = std::make_shared<BusOptions>();
  add_bus_options(*command, *options);
  command->footer(std::string(pause
                                  ? "From a tick that the coordinator names, vehicles brake, then "
                                    "stand or loiter. No time of\n"
                                    "the mission passes: what they cover does not count, and its "
                                    "end is so much later.\n"
                                  : "All go on at the same tick, which the coordinator names.\n") +
                  "Exit codes: 0 it is so; 2 several runs are heard; 3 LCM cannot be used; 4 "
                  "nobody is heard, or\n"
                  "the team was not seen to obey.");
  command->callback([&action, options, command, pause] {
    action = [options, command, pause] {
      if (const auto code = find_run(*command, *options)) return *code;
      return ask_for(pause, *options);
    };
  });
}

}  // namespace

void add_pause(CLI::App& app, Action& action) {
  add(app, action, true);
  add(app, action, false);
}

}  // namespace ergocast::cli
