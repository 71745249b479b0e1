// SPDX-License-Identifier: BSD-3-Clause
// The order to cover another target, to end at another time, to leave a zone, to cancel a zone, to
// follow another law, to look where something was sighted, or to dismiss a contact.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/operate/order.h"
#include "core/base/result.h"
#include "core/mission/amendments.h"
#include "team/messages.h"

namespace ergocast::cli {

/// What an amendment shall change.
struct AmendmentWish {
  AmendmentKind kind;
  std::vector<std::byte> content;  ///< as AMEND carries it
  std::uint64_t hash;              ///< as Amendment has it
  bool brings_back = false;        ///< the target or law that held before the newest one
  bool has_note = false;           ///< a sighting or dismissal
};
/// @param target  of the mission's basis: is_target(); number and tick do not count
AmendmentWish wish_of(const TargetChange& target);
/// @param tick_count  is_tick_count() of the mission
AmendmentWish wish_of_end(Tick tick_count);
/// @param zone  for as many ticks as it lasts; AmendOrder's delay is how many ticks it is closed
///              before nobody is inside
AmendmentWish wish_of(const Zone& zone);

/// @param law  is_law() of the mission; number and tick do not count
AmendmentWish wish_of(const LawChange& law);

/// A sighting with the target that follows from it, or a dismissal without one.
/// @param note  is_search_note() of the mission; number and tick do not count
AmendmentWish wish_of_sighting(const TargetChange& target, const SearchNote& note);
AmendmentWish wish_of_dismissal(const SearchNote& note);

/// @param number  of the amendment of the zone that ends
AmendmentWish wish_of_reopening(std::int32_t number);

/// What undoes an amendment: what held before it, or the end of its zone. An error says why it
/// cannot be undone, and what to do instead. @pre team.knows_mission()
Result<AmendmentWish, std::string> wish_to_cancel(const MonitoredRun& team, std::int32_t number);

/// Why no coordinator would name this now; nothing if one may. @pre team.knows_mission()
std::optional<std::string> why_impossible(const MonitoredRun& team, const AmendmentWish& wish,
                                          Tick delay);

class AmendOrder final : public Order {
 public:
  /// @param delay   how many ticks later than necessary it shall hold
  /// @param by  the operator, is_operator_name()
  AmendOrder(AmendmentWish wish, Tick delay, Instant now, std::string by = {});
  AmendOrder(const TargetChange& target, Tick delay, Instant now)
      : AmendOrder(wish_of(target), delay, now) {}

  void send(const MonitoredRun& team, Instant now, Outbox& out) override;
  OrderReport report(const MonitoredRun& team, Instant now) const override;

 private:
  void send_parts(const MonitoredRun& team, Outbox& out);
  OrderReport unnamed(const MonitoredRun& team, Instant now) const;
  OrderReport named(const MonitoredRun& team) const;
  Instant::duration period() const;

  AmendmentWish wish_;
  Tick delay_;
  std::string by_;
  Header header_;
  Instant since_, next_{};
  int sent_ = 0;                        // how often all parts were sent
  std::optional<std::int32_t> number_;  // of the next amendment when the mission was first known
  std::optional<std::string> problem_;  // why_impossible() at that time
  std::optional<Amendment> amendment_;  // what the coordinator has named under that number
};

/// The earliest tick that a coordinator can name now, as far as this command knows.
/// @pre team.knows_mission()
Tick earliest_tick(const MonitoredRun& team, Tick delay);
/// "agents 1 and 4 are in it" for the zone of an amendment; empty if nobody is.
std::string inside_text(const MonitoredRun& team, const Zone& zone);

/// "amendment 3, target 5f0c…, holds since tick 517, t = 51.7 s", or "holds from …, in 2.0 s of
/// wall time", "held from …, until …", "never holds: …", then ", by anna@base" if its operator is
/// known. @pre team.knows_mission()
std::string amendment_text(const MonitoredRun& team, const Amendment& amendment);

}  // namespace ergocast::cli
