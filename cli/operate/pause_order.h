// SPDX-License-Identifier: BSD-3-Clause
// The order to pause a mission, or to resume it.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>

#include "cli/operate/order.h"
#include "team/messages.h"

namespace ergocast::cli {

/// Finds out whether vehicles that still move have stopped slowing down. It counts looks, not time:
/// the process may have been stopped. Looks while a vehicle leaves a zone do not count.
class BrakingWatch {
 public:
  /// The looks without a lower speed after which they have.
  explicit BrakingWatch(int patience) : patience_(patience) {}

  bool is_stuck(const MonitoredRun::Standing& vehicles);

 private:
  int patience_;
  int idle_ = 0;
  double least_mps_ = std::numeric_limits<double>::infinity();
};

class PauseOrder final : public Order {
 public:
  /// @param pauses  true: it pauses the mission; false: it resumes it
  /// @param by  the operator, is_operator_name()
  PauseOrder(bool pauses, Instant now, std::string by = {});

  void send(const MonitoredRun& team, Instant now, Outbox& out) override;
  OrderReport report(const MonitoredRun& team, Instant now) const override;

 private:
  bool is_named(const MonitoredRun& team) const;
  OrderReport unnamed(const MonitoredRun& team, Instant now) const;
  OrderReport paused(const MonitoredRun& team) const;
  OrderReport resumed(const MonitoredRun& team) const;
  std::string why_not(const MonitoredRun& team) const;

  bool pauses_;
  std::string by_;
  Header header_;
  Instant since_, next_{};
  std::optional<std::int32_t> number_;  // of the next amendment when the mission was first known
  bool obsolete_ = false;               // the mission was already in the wanted state
  bool was_named_ = false;
};

}  // namespace ergocast::cli
