// SPDX-License-Identifier: BSD-3-Clause
// What `ergocast stop`, `pause` and `resume` share: they listen for the runs on a URL, speak to one
// of them, and wait until they hear that it obeys.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <optional>

#include "cli/report_error.h"
#include "cli/team_monitor.h"
#include "runtime/clock.h"
#include "runtime/node.h"
#include "runtime/signals.h"
#include "runtime/transport.h"

namespace ergocast::cli {

class TeamCommand {
 public:
  /// @param options  outlives it
  explicit TeamCommand(const BusOptions& options) : options_(options) {}
  virtual ~TeamCommand() = default;

  /// Opens the buses and acts; returns the exit code, after an error message.
  int carry_out();
  /// Opens the buses alone; the exit code, after an error message, if they cannot be used.
  std::optional<int> open();
  /// Whether a signal came while it listened.
  bool was_interrupted() const { return interrupted_; }

 protected:
  /// Finds the run, speaks to it and reports the result; returns the exit code.
  virtual int act() = 0;

  /// How long to wait for any process, and for a coordinator; how long a coordinator may take.
  static constexpr std::chrono::seconds kListeningTime{3}, kAnswerPatience{5};
  /// Longer than any agent is silent, so that every other run on this URL is detected.
  static constexpr auto kLookAround = 3 * kAgentStatusPeriod / 2;

  /// Listens until a run is heard, and any other on this URL would be. False if a signal came.
  bool look_around();
  /// Listens for one turn. False if a signal came.
  bool listen();
  auto waited() const { return now() - since_; }

  int nobody() const;
  int choose() const { return report_error(kExitBadInput, choice_of(runs_)); }
  int interrupted() const {
    return report_error(kExitFailed, "interrupted before the team was seen to obey");
  }

  std::unique_ptr<Transport> transport_;
  std::map<RunId, MonitoredRun> runs_;
  /// Beyond kMostRuns, received since somebody cleared it, each with its newest tick.
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
