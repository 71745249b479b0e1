// SPDX-License-Identifier: BSD-3-Clause
// The order to send one agent home, or out of the mission.
#pragma once

#include <optional>
#include <string>

#include "cli/operate/order.h"
#include "core/base/ids.h"
#include "team/messages.h"

namespace ergocast::cli {

class RecallOrder final : public Order {
 public:
  /// @param leaves  true: the agent leaves the mission; false: it goes home
  RecallOrder(AgentId agent, bool leaves, Instant now);

  void send(const MonitoredRun& team, Instant now, Outbox& out) override;
  OrderReport report(const MonitoredRun& team, Instant now) const override;

  /// Why the order cannot be given; nothing if it can. @pre team.is_running()
  std::optional<std::string> why_impossible(const MonitoredRun& team) const;

 private:
  std::string name() const;
  bool is_gone(const MonitoredRun& team) const;
  bool is_returning(const MonitoredRun& team) const;
  bool is_named(const MonitoredRun& team) const;
  OrderReport unnamed(const MonitoredRun& team, Instant now) const;
  OrderReport named(const MonitoredRun& team, Instant now) const;

  Recall recall_;
  Instant since_, next_{};
  bool was_on_its_way_ = false;         // home
  bool checked_ = false;                // why_impossible() was called, once the mission was known
  std::optional<std::string> problem_;  // its result
};

}  // namespace ergocast::cli
