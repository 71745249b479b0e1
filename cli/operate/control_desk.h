// SPDX-License-Identifier: BSD-3-Clause
// Decides which requests from a page become orders, and follows the orders. It has no clock, socket
// or output.
//
// At most one operator has control. Another operator can take it over, and both see that. An
// operator whose browser sends nothing for 10 s loses control, and the mission goes on as it is.
// Only requests of the operator with control become orders. The exception is a stop at once, for
// which the page's token suffices.
//
// A request counts once: its number must exceed all earlier numbers of the same operator. So a page
// can repeat a request under its number as long as it has seen no answer. Each order has one: it
// appears among the acts, or is refused. The sign that a browser is still there needs no new
// number.
//
// A request for control or for an order names the newest tick that the page has shown. That tick
// must be recent (team/command_window.h). A stop at once is obeyed at any tick, because a late one
// is safer than none.
//
// What was ordered elsewhere, on another page or by a command, appears among the acts as soon as
// MISSION names it.
#pragma once

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/operate/named_changes.h"
#include "cli/operate/order.h"
#include "cli/watch/control_request.h"
#include "core/base/ids.h"
#include "team/command_window.h"

namespace ergocast::cli {

class ControlDesk {
 public:
  /// Limit (Page): silence of an operator's browser [s]. Beyond it: the operator loses control.
  static constexpr std::chrono::seconds kSilence{10};
  /// Limit (Page): requests of operators in a second, other than to stop at once. Beyond it: they
  /// are refused.
  static constexpr int kMostInASecond = 20;
  /// Limit (Page): orders of operators on a page. Beyond it: the oldest that has ended, or of an
  /// agent on its way home, is no longer shown; Home and Out wait while all are unanswered.
  static constexpr std::size_t kMostActs = 8;

  /// Makes the order to cover the request's target, or to leave its zone, of the operator of that
  /// name.
  using AmendWith =
      std::function<std::unique_ptr<Order>(const ControlRequest&, const std::string& by)>;

  /// @param host   the operator's place in the record of a stop
  /// @param keyed  whether the team has a key
  ControlDesk(std::string host, bool keyed, AmendWith amend_with)
      : host_(std::move(host)), keyed_(keyed), amend_with_(std::move(amend_with)) {}

  /// Turns a request into an order, or refuses it.
  void receive(const ControlRequest& request, const MonitoredRun& team, Instant now);
  /// Refuses a request that came while advance() was not called for some seconds. A stop at once is
  /// received.
  void receive_late(const ControlRequest& request, const MonitoredRun& team, Instant now);
  /// Call if advance() was not called for some seconds: the operator's browser is not to blame.
  void wake(Instant now);
  /// Appends the messages that are due, and judges what the team has reported. Call at least ten
  /// times a second.
  void advance(const MonitoredRun& team, Instant now, Outbox& out);

  /// The mission is over, and its processes have ended: judges the orders that still wait.
  /// advance() is called no more.
  void end(const MonitoredRun& team, Instant now);
  /// Whether no order waits for anything.
  bool is_settled() const;

  /// What every page shows: {"over": true after end(), "operator", "acts", "refused"}. The newest
  /// of a list is the last.
  nlohmann::ordered_json state() const;
  /// Lines for the log since the last call: each request, its operator, its time and its outcome.
  std::vector<std::string> take_lines() { return std::exchange(lines_, {}); }

 private:
  /// The most refused requests that pages receive: so one does not hide another of the same moment.
  static constexpr std::size_t kMostRefused = 8;

  struct Operator {
    std::uint32_t id;
    std::string name;
    Instant last_sign;
  };
  struct Act {
    ControlRequest request;
    std::string what;  ///< "pause", "agent 2 home"
    std::string at;    ///< mission time
    std::unique_ptr<Order> order;
    OrderReport report = {};
    bool named = false;  ///< MISSION has named it, or it was given elsewhere
    bool over() const { return order == nullptr; }
  };
  /// The last number of each operator.
  struct Numbers {
    /// The most operators whose numbers are remembered.
    static constexpr std::size_t kMost = 64;
    std::deque<std::pair<std::uint32_t, std::int64_t>> last;

    bool is_new(const ControlRequest& request);
  };

  std::optional<std::string> why_refused(const ControlRequest& request, const MonitoredRun& team,
                                         Instant now);
  std::optional<std::string> why_not_amended(const ControlRequest& request,
                                             const MonitoredRun& team) const;
  bool is_replaced_in_vain(const ControlRequest& request) const;
  bool is_answered(const ControlRequest& request) const;
  void refuse(const ControlRequest& request, std::string why);
  bool within_rate(Instant now);
  bool is_held_by(const ControlRequest& request) const;
  void change_operator(const ControlRequest& request, const MonitoredRun& team, Instant now);
  void give(const ControlRequest& request, const MonitoredRun& team, Instant now);
  std::unique_ptr<Order> order_for(const ControlRequest& request, const MonitoredRun& team,
                                   Instant now) const;
  void note_changes(const MonitoredRun& team);
  void end_contradicted(const ControlRequest& request);
  void make_room();
  void note_end(const Act& act, const std::string& then);
  void note(const std::string& line) { lines_.push_back("control: " + line); }

  std::string host_;
  bool keyed_;
  AmendWith amend_with_;
  std::optional<Operator> operator_;
  Numbers numbers_;
  CommandWindow window_;
  NamedChanges changes_;
  std::deque<Act> acts_;                                        // the newest last
  std::deque<std::pair<ControlRequest, std::string>> refused_;  // and why; the newest last
  std::vector<std::string> lines_;
  std::int64_t elsewhere_ = 0;  // how many acts were given elsewhere
  bool ended_ = false;
  Instant second_{};
  int in_this_second_ = 0, over_rate_ = 0;
};

}  // namespace ergocast::cli
