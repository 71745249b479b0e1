// SPDX-License-Identifier: BSD-3-Clause
// Gives orders to one team for the operators of its page. It listens to the team, and holds the key
// that signs orders. The page's process does not have that key, and publishes nothing.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/operate/control_desk.h"
#include "cli/team/team_monitor.h"
#include "cli/watch/control_link.h"
#include "core/base/ids.h"
#include "core/base/result.h"
#include "runtime/bus/transport.h"
#include "runtime/process/program_options.h"

namespace ergocast::cli {

class Control {
 public:
  /// @param team   its run is known, and its key can sign
  /// @param print  gets the lines of the log
  /// An error if LCM cannot be used, or the system has no descriptors.
  static Result<std::unique_ptr<Control>> open(const BusOptions& team,
                                               std::function<void(const std::string&)> print);

  /// Receives requests, follows orders and sends the state to the page. Call at least ten times a
  /// second.
  void attend(Instant now);
  /// Listens until `until`, or until `wake_fd` is readable. For a caller that has no other bus.
  void listen(Instant until, int wake_fd) { transport_->deliver_until(until, wake_fd); }

  /// Sends the page the last state: the mission is over, and no order has an effect. attend() is
  /// called no more.
  void end(Instant now);

  /// Whether the mission's end has been received.
  bool over() const { return team_.over(); }
  /// Whether no order waits for anything.
  bool is_settled() const { return desk_.is_settled(); }
  /// The page's end of the link. The page's process inherits it.
  const ControlLink& page_end() const { return links_.second; }
  /// Each request of a page must have this token.
  const std::string& token() const { return token_; }

 private:
  void print_lines();
  std::string state_text() const;
  Control(const BusOptions& team, std::pair<ControlLink, ControlLink> links,
          std::function<void(const std::string&)> print);

  std::pair<ControlLink, ControlLink> links_;  // ours, and the page's
  std::function<void(const std::string&)> print_;
  std::string token_;
  MonitoredRun team_;
  ControlDesk desk_;
  std::unique_ptr<Transport> transport_;
  std::string state_;  // the last that was sent to the page
  Instant next_state_{};
  std::optional<Instant> last_attended_;
};

}  // namespace ergocast::cli
