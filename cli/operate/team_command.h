// SPDX-License-Identifier: BSD-3-Clause
// The common part of the commands that give orders (cli/operate/order.h). A command listens for the
// runs on a URL and gives the order to one of them. Then it waits until the run's messages show
// that it obeys.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>

#include "cli/operate/order.h"
#include "cli/report_error.h"
#include "cli/team/team_monitor.h"
#include "runtime/bus/clock.h"
#include "runtime/bus/transport.h"
#include "runtime/process/program_options.h"
#include "runtime/process/signals.h"

namespace ergocast::cli {

class TeamCommand {
 public:
  /// @param options  outlives this object
  explicit TeamCommand(const BusOptions& options) : options_(options) {}
  virtual ~TeamCommand() = default;

  /// Opens the buses and acts. Prints errors; returns the exit code.
  int carry_out();
  /// Only opens the buses. If they cannot be used, prints an error and returns the exit code.
  std::optional<int> open();
  /// Whether a signal has arrived during listen().
  bool was_interrupted() const { return interrupted_; }

 protected:
  /// Finds the run, sends the request and reports the result; returns the exit code.
  virtual int act() = 0;

  static constexpr auto kListeningTime = Order::kListeningTime;
  static constexpr std::chrono::milliseconds kTurnTime{20};
  /// Longer than the interval between an agent's messages, so that every other run on this URL is
  /// detected.
  static constexpr auto kLookAround = 3 * kAgentStatusPeriod / 2;

  /// Listens until a run is received, and long enough to receive any other run on this URL. False
  /// if a signal arrived.
  bool look_around();
  /// Listens for one turn, kTurnTime. False if a signal arrived.
  bool listen();
  /// Finds the only run on this URL and listens to it alone. If there is none, or several, prints
  /// an error and returns the exit code.
  std::optional<int> choose_run();
  /// Sends what is due of an order to that run. @pre choose_run()
  OrderReport turn(Order& order);
  /// Gives the order to that run until the team obeys or the order has failed, and prints the
  /// coordinator's answer. Nothing if a signal arrived. @pre choose_run()
  std::optional<OrderReport> obeyed(Order& order);
  auto waited() const { return now() - since_; }

  int nobody() const;
  int choose() const { return report_error(kExitBadInput, choice_of(runs_)); }
  int interrupted() const {
    return report_error(kExitFailed, "interrupted before the team was seen to obey");
  }

  std::unique_ptr<Transport> transport_;
  std::map<RunId, MonitoredRun> runs_;
  /// Runs beyond kMostRuns since it was last cleared, each with its newest tick.
  std::map<RunId, Tick> crowd_;
  Instant since_{};

 private:
  void receive(const Message& message, Bus bus, AgentId transmitter);

  const BusOptions& options_;
  StopSignals signals_;
  bool interrupted_ = false;
  RunId replay_ = 0;  // of the newest message that `ergocast replay` sent; 0: none
};

}  // namespace ergocast::cli
