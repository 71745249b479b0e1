// SPDX-License-Identifier: BSD-3-Clause
// The order to end a mission: by its coordinator, in order, or at once.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/operate/order.h"
#include "cli/operate/stop_request.h"

namespace ergocast::cli {

class StopOrder final : public Order {
 public:
  /// @param at_once  all processes stop at once, and the vehicles stand still
  /// @param reason   for the mission's record
  /// @param keyed    whether the team has a key
  StopOrder(RunId run, bool at_once, std::string reason, bool keyed, Instant now);

  void send(const MonitoredRun& team, Instant now, Outbox& out) override;
  OrderReport report(const MonitoredRun& team, Instant now) const override;
  OrderReport report_at_end(const MonitoredRun& team, Instant now) const override {
    return concluded(team, now);
  }

 private:
  std::vector<std::string> awaited(const MonitoredRun& team, Instant now) const;
  std::optional<std::string> why_not_in_order(const MonitoredRun& team, Instant now) const;
  OrderReport unfinished(const MonitoredRun& team, bool obeyed, Instant now) const;
  OrderReport concluded(const MonitoredRun& team, Instant now) const;

  StopRequest request_;
  bool at_once_, keyed_;
  Instant since_;
};

}  // namespace ergocast::cli
