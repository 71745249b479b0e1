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
#include "cli/operate/stop_order.h"
#include "cli/operate/stop_request.h"
#include "cli/operate/team_command.h"
#include "cli/watch/find_run.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

/// How long a run that reads its scenario may take to exit.
constexpr auto kLongestEnd = 15s;
constexpr auto kLookPeriod = 50ms;
/// After this time the result so far is reported.
constexpr auto kReportAfter = 250ms;
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
  /// Listens for one turn and judges the answers; returns the exit code once all runs have one.
  std::optional<int> judge_answers() {
    if (!listen()) return interrupted();
    for (auto& [run, request] : requests_) {
      if (!request.code) judge(request, runs_.at(run));
    }
    return result();
  }

 private:
  /// The request to one run.
  struct Request {
    StopOrder order;
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
    const auto [at, is_new] = requests_.try_emplace(
        run,
        Request{StopOrder(run, options_.at_once, how + host_name(), transport_->keyed(), now()),
                now()});
    Request& request = at->second;
    if (is_new) {
      print(run, options_.at_once ? "stopping all vehicles at once"
                                  : "asking the coordinator to end the mission");
    }
    if (request.code) return;
    Outbox out;
    request.order.send(team, now(), out);
    transport_->publish(out);
  }

  /// Runs beyond kMostRuns must stop, too. Other runs, or recordings of them, may fill the table.
  void send_stop_to_the_crowd() {
    if (!options_.at_once) return;
    Outbox out;
    for (const auto& [run, tick] : crowd_) {
      StopRequest(run, false, kAtOnce + host_name())
          .repeat(now(), true, tick, transport_->keyed(), out);
    }
    transport_->publish(out);
    crowded_ = crowded_ || !crowd_.empty();
    crowd_.clear();
  }

  /// The exit code; nullopt while a new run may still appear, or a run has no exit code yet.
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

  /// Sets the exit code once it is known, and reports the result so far once if the rest takes
  /// longer.
  void judge(Request& request, const MonitoredRun& team) const {
    const auto waited = now() - request.since;
    const OrderReport report = request.order.report(team, now());
    if (team.unheard()) {
      if (waited >= kListeningTime) request.code = nobody();
      return;
    }
    if (report.state == OrderReport::State::kFailed) {
      request.code = report_error(kExitFailed, "run " + to_hex(team.run()) + ": " + report.text);
    } else if (report.state == OrderReport::State::kDone) {
      print(team.run(), report.text);
      request.code = kExitDone;
    } else if (!request.reported && waited >= kReportAfter) {
      request.reported = true;
      print(team.run(), report.text);
    }
  }

  static void print(RunId run, const std::string& text) {
    std::printf("run %s: %s\n", to_hex(run).c_str(), text.c_str());
    std::fflush(stdout);
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

/// Ends a run that still reads its scenario. Such a run has no team, only a process of this user.
void end_preparing(const LiveRun& run) {
  std::printf("run %s: ending it while it reads its scenario\n", to_hex(run.run).c_str());
  std::fflush(stdout);
  kill(run.pid, SIGTERM);
}

/// Waits until the run has ended; returns the exit code.
int await_end(const LiveRun& run) {
  const auto is_it = [&run](const LiveRun& one) { return one.run == run.run; };
  for (const Instant until = now() + kLongestEnd; now() < until;
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
