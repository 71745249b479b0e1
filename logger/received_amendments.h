// SPDX-License-Identifier: BSD-3-Clause
// All amendments of a mission that its recorder has received.
//
// The list that MISSION carries names the newest amendments, and has the numbers of two targets and
// two laws. A record needs all: rows are written some ticks after they are known, and read years
// later.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "core/mission/amendments.h"

namespace ergocast {

struct ReceivedAmendment {
  Amendment amendment;
  /// kTarget: its numbers; nothing if no list that was received has them.
  std::optional<TargetChange> target{};
  /// kZone: the zone; nothing if no list that was received has it.
  std::optional<Zone> zone{};
  /// kLaw: its numbers; nothing if no list that was received has them.
  std::optional<LawChange> law{};
  /// kDismiss, and kTarget if it follows from a sighting; nothing if no list that was received has
  /// it.
  std::optional<SearchNote> note{};
  /// Whether a later list lacks it: its coordinator stopped before another process knew of it.
  bool is_void = false;

  bool operator==(const ReceivedAmendment&) const = default;
};

/// From which tick on the zone of an amendment is cancelled; −1: it is not.
/// @param listed  the zones of the newest list, which has only those that had not ended
/// @param known   all amendments that are known; they count for a zone that has left the list
Tick cancelled_at(std::int32_t number, std::span<const Zone> listed,
                  std::span<const Amendment> known);

class ReceivedAmendments {
 public:
  ReceivedAmendments() = default;
  /// Those of a record. @pre ascending by number
  ReceivedAmendments(std::vector<ReceivedAmendment> all, std::vector<Hold> holds);

  /// Takes in the newest list. @pre are_amendments(list, mission)
  void note(const Amendments& list);

  bool empty() const { return all_.empty() && holds_.empty(); }
  /// Ascending by number; of equal numbers at most one is not void.
  const std::vector<ReceivedAmendment>& all() const { return all_; }
  /// Ticks that do not count.
  const std::vector<Hold>& holds() const { return holds_; }
  /// The ends that are not void.
  std::vector<EndChange> ends() const;
  /// Sightings and dismissals that are not void. A sighting whose target was replaced before it
  /// held is not among them.
  std::vector<SearchNote> notes() const;
  /// The target that holds at a tick of the world; null: the plan's. Its numbers are there.
  const ReceivedAmendment* target_at(Tick tick) const;
  /// The first that is not void and whose target, zone, law or contact was not received; null:
  /// there is none.
  const ReceivedAmendment* unknown_content() const;
  /// Those that are not void as one list, with all targets, zones, laws and notes that were
  /// received.
  Amendments list() const;

 private:
  void compare(const Amendments& list);
  void take_in(const SearchNote& note);
  void note_cancelled(const Amendments& list);
  ReceivedAmendment& add(const Amendment& amendment);

  std::vector<ReceivedAmendment> all_;
  std::vector<Hold> holds_;
  std::optional<Amendments> newest_;  // the list that was noted last
};

}  // namespace ergocast
