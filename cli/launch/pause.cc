// SPDX-License-Identifier: BSD-3-Clause
// `ergocast pause` and `ergocast resume`: stop a team for a while and continue.
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>

#include "cli/commands.h"
#include "cli/launch/team_command.h"
#include "cli/watch/find_run.h"
#include "runtime/bus/random_identity.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

/// How long to wait for the whole mission; agents of a large team send it in turn.
constexpr auto kMissionPatience = 20s;
constexpr auto kPeriod = 100ms;

class Pausing : public TeamCommand {
 public:
  Pausing(const BusOptions& options, bool pauses) : TeamCommand(options), pauses_(pauses) {}

 private:
  int act() override {
    if (!look_around()) return interrupted();
    if (runs_.empty()) return nobody();
    if (runs_.size() > 1) return choose();
    transport_->set_run(team().run());
    while (!team().is_running() && !team().over() && waited() < kMissionPatience) {
      ask_for_mission();
      if (!listen()) return interrupted();
    }
    if (!team().is_running()) return refused();
    changes_ = named_changes(team().holds());
    since_ = now();
    next_ = since_;
    return is_done() ? there_already() : insist();
  }

  const MonitoredRun& team() const { return runs_.begin()->second; }
  std::string mission_time(Tick tick) const { return team().mission_time(tick); }
  /// Whether a message names the tick.
  bool is_done() const { return is_open(team().holds()) == pauses_; }
  Tick named() const {
    const Hold& last = team().holds().back();
    return pauses_ ? last.from : last.until;
  }

  int insist() {
    while (!is_done()) {
      publish_pause();
      if (!listen()) return interrupted();
      if (team().over()) return ended_before();
      if (!is_done() && waited() >= kAnswerPatience) return report_error(kExitFailed, why_not());
    }
    return pauses_ ? wait_for_the_pause() : report_resumption();
  }

  /// In real time the tick comes two seconds later, and vehicles move until then.
  int wait_for_the_pause() {
    if (team().tick() < named()) {
      std::printf("the coordinator pauses the mission at %s, in %.1f s\n",
                  mission_time(named()).c_str(), team().seconds_until(named()));
      std::fflush(stdout);
    }
    while (team().tick() < named()) {
      if (!listen()) return interrupted();
      if (team().over()) return ended_before();
    }
    std::printf("paused at %s: `ergocast resume` continues the mission\n",
                mission_time(named()).c_str());
    return kExitDone;
  }

  /// Nothing depends on its time of arrival, so no process waits for it.
  int report_resumption() const {
    std::printf("the mission goes on at %s, in %.1f s\n", mission_time(named()).c_str(),
                team().seconds_until(named()));
    return kExitDone;
  }

  int ended_before() const {
    return report_error(kExitFailed, "the mission had already ended: " + team().reason());
  }

  /// The coordinator sends MISSION once a second; an agent repeats it at once.
  void ask_for_mission() {
    if (now() < next_) return;
    next_ = now() + kPeriod;
    Hello question;
    question.header = {team().run(), kOperator, header_.incarnation, ++header_.sequence, -1};
    transport_->publish({Bus::kSwarm, question});
  }

  void publish_pause() {
    if (now() < next_) return;
    next_ = now() + kPeriod;
    ++header_.sequence;
    header_.run = team().run();
    header_.tick = team().tick();
    transport_->publish({Bus::kSwarm, Pause{header_, changes_, {}}});
  }

  int there_already() const {
    if (pauses_) {
      std::printf("the mission is paused already, at %s\n", mission_time(named()).c_str());
    } else {
      std::printf("the mission is not paused\n");
    }
    return kExitDone;
  }
  int refused() const {
    return report_error(
        kExitFailed,
        team().over() ? "the mission is over: " + team().reason()
        : team().knows_mission()
            ? "the mission has not begun: it waits for its quorum, and no vehicle moves"
            : "the mission was not received: is its coordinator running?");
  }
  std::string why_not() const {
    if (!team().coordinator_seen())
      return "no coordinator answers, and only a coordinator names the tick: start one with "
             "ergocast-coordinator --resume, or end the mission with ergocast stop --now";
    if (team().holds().size() == kMaxHolds && pauses_)
      return "a mission can be paused " + std::to_string(kMaxHolds) +
             " times, and this one has been: end it with ergocast stop";
    return "the coordinator names no tick: it may have another key, or receive no world";
  }

  const bool pauses_;
  Header header_{0, kOperator, random_identity(), 0, 0};
  std::int32_t changes_ = 0;  // as counted in the first MISSION
  Instant next_{};
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
