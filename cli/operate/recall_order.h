// SPDX-License-Identifier: BSD-3-Clause
// The order to send one agent home, or out of the mission: it sends RECALL until the team's
// messages show that it is obeyed, and reports the progress. It prints nothing.
#pragma once

#include <string>

#include "cli/team/team_monitor.h"
#include "core/base/ids.h"
#include "runtime/bus/transport.h"
#include "team/messages.h"

namespace ergocast::cli {

/// What an order reports.
struct OrderProgress {
  enum class State { kUnderWay, kDone, kFailed };
  State state = State::kUnderWay;
  std::string text;  ///< a sentence for people; empty: nothing to report yet
};

class RecallOrder {
 public:
  /// @param leaves  out of the mission
  /// @param since  when it was given
  RecallOrder(AgentId agent, bool leaves, Instant since);

  /// Sends what is due to the run `team`. Once it is done or has failed, it sends nothing more.
  OrderProgress advance(const MonitoredRun& team, Transport& transport, Instant now);

  /// The error if the order cannot be given; empty if it can. @pre team.is_running()
  std::string why_impossible(const MonitoredRun& team) const;

 private:
  std::string name() const;
  bool is_gone(const MonitoredRun& team) const;
  bool is_obeyed(const MonitoredRun& team) const;
  OrderProgress report(const MonitoredRun& team, Instant now);
  void send(const MonitoredRun& team, Transport& transport, Instant now);
  std::string why_not(const MonitoredRun& team) const;

  Recall recall_;
  Instant since_;
  Instant next_{};
  bool checked_ = false;  // whether it was possible at its first turn
};

}  // namespace ergocast::cli
