// SPDX-License-Identifier: BSD-3-Clause
// An order of an operator to a running team. It is repeated until the team's own messages show that
// the team obeys.
//
// `ergocast amend`, `pause`, `resume`, `stop` and `recall` and the buttons of the page give the
// same orders. An order has no clock, sends through an outbox, and prints nothing.
#pragma once

#include <chrono>
#include <string>

#include "cli/team/team_monitor.h"
#include "core/base/ids.h"
#include "team/messages.h"

namespace ergocast::cli {

/// What the team has reported about an order.
struct OrderReport {
  enum class State {
    kSent,      ///< nothing shows that the team obeys
    kAnswered,  ///< the coordinator has answered; robots do not obey yet
    kObeyed,    ///< the team obeys; robots may still brake, or be on their way
    kDone,      ///< the order is carried out
    kFailed,    ///< `text` has the cause and the remedy
  };
  State state = State::kSent;
  std::string text;  ///< a sentence for people, without a full stop

  /// Whether this report is the last one.
  bool ended() const { return state == State::kDone || state == State::kFailed; }
};

class Order {
 public:
  /// How often an order is repeated.
  static constexpr std::chrono::milliseconds kRepeatPeriod{100};
  /// How long to wait for the first process of a team, and for a coordinator.
  static constexpr std::chrono::seconds kListeningTime{3};
  /// How long to wait for a coordinator's answer.
  static constexpr std::chrono::seconds kAnswerPatience{5};

  virtual ~Order() = default;

  /// Appends the messages that are due, in order.
  virtual void send(const MonitoredRun& team, Instant now, Outbox& out) = 0;
  /// Call after send(), with the same team.
  virtual OrderReport report(const MonitoredRun& team, Instant now) const = 0;
  /// The last report: the mission's processes have ended, and no further message will arrive.
  virtual OrderReport report_at_end(const MonitoredRun& team, Instant now) const;
};

/// The report of an order that has waited for the mission so far.
OrderReport waiting_for_mission(const MonitoredRun& team, Instant::duration waited);

/// Asks for the mission under an operator's header, and numbers the message. The coordinator sends
/// MISSION only once a second; an agent repeats it at once.
Outgoing mission_question(const MonitoredRun& team, Header& header);

/// Why a coordinator has not named the tick of an amendment.
std::string why_no_tick(const MonitoredRun& team);

/// "anna@base": the operator of this process, as amendments name it.
std::string own_operator_name();

/// ", in 2.0 s of wall time", or nothing if the time is not known.
std::string in_seconds(double seconds);

/// "4 of 6 stand, 1 circles; agent 2 still moves", from the world's newest states. A fixed wing
/// circles, because it cannot stand.
std::string standing_text(const MonitoredRun& team);

}  // namespace ergocast::cli
