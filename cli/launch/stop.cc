// SPDX-License-Identifier: BSD-3-Clause
// `ergocast stop`: ends missions from any host on their buses, and reports whether the teams
// obeyed.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "cli/commands.h"
#include "cli/launch/stop_request.h"
#include "cli/launch/team_command.h"
#include "cli/watch/find_run.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

/// How long the team may take to exit.
constexpr auto kLongest = 15s;
constexpr auto kLookPeriod = 50ms;
/// After this time the result so far is reported.
constexpr auto kReportAfter = 250ms;
/// Without a roster an emergency stop is repeated at least this long, because an unknown process
/// may miss the first ones.
constexpr auto kLeastInsistence = 1s;
constexpr const char* kAtOnce = "stopped at once by `ergocast stop --now` on ";

struct StopOptions : BusOptions {
  bool at_once = false;
};

/// Ends one run on a URL in order, or stops all received runs at once.
class Stopping : public TeamCommand {
 public:
  explicit Stopping(const StopOptions& options) : TeamCommand(options), options_(options) {}

  /// Sends STOP to every run that is known, if it is due.
  void send_stops() {
    if (options_.run != 0) runs_.try_emplace(options_.run, options_.run, since_);
    for (const auto& [run, team] : runs_) send_stop_to(run, team);
    send_stop_to_the_crowd();
  }
  /// Listens for a moment and evaluates; returns the exit code once all is known.
  std::optional<int> judge_answers() {
    if (!listen()) return interrupted();
    for (auto& [run, request] : requests_) {
      const MonitoredRun& team = runs_.at(run);
      if (!request.code) request.code = verdict(request, team);
      if (!request.code) report_progress(request, team);
    }
    return result();
  }

 private:
  /// The request to one run.
  struct Request {
    StopRequest word;
    Instant since;
    bool reported = false;  // the result so far was reported
    std::optional<int> code = {};
  };

  int act() override {
    if (!options_.at_once) {
      if (options_.run == 0 && !look_around()) return interrupted();
      if (runs_.size() > 1) return choose();
      if (runs_.empty() && options_.run == 0) return nobody();
      if (options_.run == 0) transport_->set_run(runs_.begin()->first);
    }
    while (true) {
      send_stops();
      if (const auto code = judge_answers()) return *code;
    }
  }

  void send_stop_to(RunId run, const MonitoredRun& team) {
    const char* how = options_.at_once ? kAtOnce : "stopped by `ergocast stop` on ";
    const auto [at, is_new] =
        requests_.try_emplace(run, Request{StopRequest(run, false, how + host_name()), now()});
    Request& request = at->second;
    if (is_new) {
      std::printf("run %s: %s\n", to_hex(run).c_str(),
                  options_.at_once ? "stopping all vehicles at once"
                                   : "asking the coordinator to end the mission");
      std::fflush(stdout);
    }
    const bool obeyed = request.code || (!options_.at_once && team.over());
    if (!obeyed) request.word.repeat(*transport_, now(), options_.at_once, team.tick());
  }

  /// Runs beyond kMostRuns must stop, too. Other runs, or recordings of them, may fill the table.
  void send_stop_to_the_crowd() {
    if (!options_.at_once) return;
    for (const auto& [run, tick] : crowd_) {
      StopRequest(run, false, kAtOnce + host_name()).repeat(*transport_, now(), true, tick);
    }
    crowded_ = crowded_ || !crowd_.empty();
    crowd_.clear();
  }

  /// The exit code; nullopt while a new run may still appear, or a run has not answered.
  std::optional<int> result() const {
    if (options_.run == 0 && waited() < (runs_.empty() ? kListeningTime : kLookAround))
      return std::nullopt;
    if (runs_.empty()) return nobody();
    int worst = kExitDone;
    for (const auto& [run, team] : runs_) {
      const auto request = requests_.find(run);
      if (request == requests_.end() || !request->second.code) return std::nullopt;
      worst = std::max(worst, *request->second.code);
    }
    if (!crowded_) return worst;
    return report_error(kExitFailed,
                        "more than " + std::to_string(kMostRuns) +
                            " runs were found, perhaps with recordings among them; the stop was "
                            "sent to all, but not all were seen to obey: repeat it with --run-id");
  }

  std::vector<std::string> awaited(const MonitoredRun& team) const {
    return options_.at_once ? team.still_moving(now()) : team.still_there(now());
  }

  /// The exit code; nullopt while it is unknown.
  std::optional<int> verdict(const Request& request, const MonitoredRun& team) const {
    const auto waited = now() - request.since;
    if (team.unheard()) return waited < kListeningTime ? std::nullopt : std::optional(nobody());
    const bool world_due = options_.at_once && !team.world_seen() && team.tick() > 0;
    if (world_due && waited < kListeningTime) return std::nullopt;
    const auto left = awaited(team);
    const bool obeyed =
        options_.at_once ? team.knows_roster() || waited >= kLeastInsistence : team.over();
    if (obeyed && left.empty()) return conclude(team);
    if (waited >= kLongest) {
      return fail(team, "still running: " + listed(left) +
                            (options_.at_once ? ": end them on their hosts"
                                              : ": ergocast stop --now stops them at once"));
    }
    if (obeyed || options_.at_once) return std::nullopt;
    return why_not_in_order(team, waited);
  }

  std::optional<int> why_not_in_order(const MonitoredRun& team, Instant::duration waited) const {
    if (!team.coordinator_seen() && waited >= kListeningTime) {
      return fail(team,
                  "no coordinator answers, and only a coordinator ends a mission in order: "
                  "ergocast stop --now stops the team at once");
    }
    if (waited >= kAnswerPatience) {
      return fail(team,
                  "the coordinator does not end the mission: ergocast stop --now stops "
                  "the team at once");
    }
    return std::nullopt;
  }

  /// Reports the result so far once, if the rest takes longer.
  void report_progress(Request& request, const MonitoredRun& team) const {
    if (request.reported || now() - request.since < kReportAfter) return;
    request.reported = true;
    const bool at_once = options_.at_once;
    const char* obeyed = !at_once ? (team.over() ? "the coordinator has ended the mission"
                                                 : "the coordinator has not answered yet")
                         : !team.world_seen()  ? "no world or driver answers yet"
                         : team.stands_still() ? "all vehicles stand still"
                                               : "vehicles still move";
    const auto left = awaited(team);
    std::printf("run %s: %s%s%s\n", to_hex(team.run()).c_str(), obeyed,
                left.empty() ? "" : "; waiting for ", listed(left).c_str());
    std::fflush(stdout);
  }

  int conclude(const MonitoredRun& team) const {
    // A mission that never started has moved no vehicle.
    if (options_.at_once && !team.world_seen() && team.tick() > 0) {
      return fail(team,
                  "no messages arrive any more, and none came from a world or driver: it is "
                  "unknown whether the vehicles stand still: look at them");
    }
    if (options_.at_once && !team.stands_still()) {
      return fail(team, "the world is silent, and in its last state, of " +
                            team.mission_time(team.tick()) + ", vehicles still move: look at them");
    }
    const auto lost = team.lost(now());
    const std::string but = lost.empty() ? "" : "; " + listed(lost) + " did not confirm it";
    std::printf("run %s: %s at %s: %s%s\n", to_hex(team.run()).c_str(),
                options_.at_once ? "stopped" : "the mission has ended",
                team.mission_time(team.tick()).c_str(),
                options_.at_once ? "all stand still" : team.reason().c_str(), but.c_str());
    std::fflush(stdout);
    return kExitDone;
  }

  static int fail(const MonitoredRun& team, const std::string& problem) {
    return report_error(kExitFailed, "run " + to_hex(team.run()) + ": " + problem);
  }

  const StopOptions& options_;
  std::map<RunId, Request> requests_;
  bool crowded_ = false;
};

/// Stops the teams on several URLs at the same time; no team waits for another one.
/// @param code  exit code for runs that cannot be stopped; an error was printed for each
int stop_at_once(const std::vector<StopOptions>& teams, int code) {
  std::vector<std::unique_ptr<Stopping>> stoppings;
  for (const StopOptions& team : teams) {
    auto& one = stoppings.emplace_back(std::make_unique<Stopping>(team));
    if (const auto failed = one->open()) {
      code = std::max(code, *failed);
      stoppings.pop_back();
    }
  }
  bool interrupted = false;
  while (!stoppings.empty() && !interrupted) {
    for (const auto& one : stoppings) one->send_stops();
    std::erase_if(stoppings, [&](const auto& one) {
      const auto ended = one->judge_answers();
      code = std::max(code, ended.value_or(code));
      interrupted = interrupted || one->was_interrupted();
      return ended.has_value();
    });
  }
  return code;
}

/// Asks a run to end that still reads its scenario. It has no team, only a process of this user.
void end_preparing(const LiveRun& run) {
  std::printf("run %s: ending it while it reads its scenario\n", to_hex(run.run).c_str());
  std::fflush(stdout);
  kill(run.pid, SIGTERM);
}

/// The exit code, once that run is no longer live or does not end.
int await_end(const LiveRun& run) {
  const auto is_it = [&run](const LiveRun& one) { return one.run == run.run; };
  for (const Instant until = now() + kLongest; now() < until;
       std::this_thread::sleep_for(kLookPeriod)) {
    if (std::ranges::none_of(live_runs().runs, is_it)) return kExitDone;
  }
  return report_error(kExitFailed, "run " + to_hex(run.run) + ": process " +
                                       std::to_string(run.pid) + " does not end: kill it");
}

int stop_found(const CLI::App& command, StopOptions options) {
  if (!options.at_once) {
    if (const auto code = find_run(command, options)) return *code;
    return Stopping(options).carry_out();
  }
  const FoundRuns found = find_runs(command, options);
  for (const LiveRun& run : found.preparing) end_preparing(run);
  std::vector<StopOptions> teams;
  for (const BusOptions& team : found.runs) teams.push_back({team, true});
  int code = stop_at_once(teams, found.code);
  for (const LiveRun& run : found.preparing) code = std::max(code, await_end(run));
  return code;
}

}  // namespace

void add_stop(CLI::App& app, Action& action) {
  auto* command = app.add_subcommand("stop", "End a running mission, in order or at once");
  auto options = std::make_shared<StopOptions>();
  add_bus_options(*command, *options);
  describe_search(*command);
  command->add_flag(
      "--now", options->at_once,
      "Emergency: agents and world stand still within a tick, also without a coordinator");
  command->footer(
      "Without --now the coordinator ends the mission for all. With --now all live runs of this\n"
      "user on this host stop, or with --lcm-url all runs on that URL; --run-id chooses one. A\n"
      "team with a key obeys after this host has received its messages, because the command then\n"
      "names the mission's tick.\n"
      "Exit codes: 0 the teams were seen to end, or to stand still; 2 several runs are found; 3 "
      "LCM\n"
      "cannot be used; 4 no team is found, a team goes on, or the state of the vehicles is "
      "unknown.");
  command->callback([&action, options, command] {
    action = [options, command] { return stop_found(*command, *options); };
  });
}

}  // namespace ergocast::cli
