// SPDX-License-Identifier: BSD-3-Clause
// The order to cover another target, or to leave a zone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/operate/order.h"
#include "core/mission/amendments.h"
#include "team/messages.h"

namespace ergocast::cli {

class AmendOrder final : public Order {
 public:
  /// @param target  of the mission's basis: is_target(); number and tick do not count
  /// @param delay   how many ticks later than necessary it shall hold
  AmendOrder(const TargetChange& target, Tick delay, Instant now);
  /// @param zone    for as many ticks as it lasts
  /// @param notice  how many ticks it is closed before nobody is inside
  AmendOrder(const Zone& zone, Tick notice, Instant now);

  void send(const MonitoredRun& team, Instant now, Outbox& out) override;
  OrderReport report(const MonitoredRun& team, Instant now) const override;

 private:
  void send_parts(const MonitoredRun& team, Outbox& out);
  std::optional<std::string> why_impossible(const MonitoredRun& team) const;
  OrderReport unnamed(const MonitoredRun& team, Instant now) const;
  OrderReport named(const MonitoredRun& team) const;
  Instant::duration period() const;

  AmendmentKind kind_ = AmendmentKind::kTarget;
  std::vector<std::byte> content_;
  std::uint64_t hash_;
  Tick delay_;
  Header header_;
  Instant since_, next_{};
  int sent_ = 0;                        // how often all parts were sent
  std::optional<std::int32_t> number_;  // of the next amendment when the mission was first known
  std::optional<std::string> problem_;  // why_impossible() at that time
  std::optional<Amendment> amendment_;  // what the coordinator has named under that number
};

/// "agents 1 and 4 are in it" for the zone of an amendment; empty if nobody is.
std::string inside_text(const MonitoredRun& team, const Zone& zone);

/// "amendment 3, target 5f0c…, holds since tick 517, t = 51.7 s", or "… holds from tick 517,
/// t = 51.7 s, in 2.0 s". @pre team.knows_mission()
std::string amendment_text(const MonitoredRun& team, const Amendment& amendment);

}  // namespace ergocast::cli
