// SPDX-License-Identifier: BSD-3-Clause
// What has changed in a mission since its plan: pauses, new targets, other ends, zones and their
// cancellation, other speeds and noise of the law, sightings, and contacts that are dismissed.
//
// The coordinator names each amendment: it gives it the next number, and the world's tick from
// which it holds. All processes learn of an amendment before its tick, so all change at the same
// tick. The list of one coordinator only grows.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/ids.h"
#include "core/basis/basis.h"
#include "core/mission/hold.h"
#include "core/mission/law_change.h"
#include "core/mission/mission.h"
#include "core/mission/search_note.h"
#include "core/mission/zones.h"

namespace ergocast {

enum class AmendmentKind {
  kPause,    ///< the mission is paused: a Hold begins
  kResume,   ///< the mission goes on: the last Hold ends
  kTarget,   ///< the team covers another target, perhaps one that follows from a sighting
  kEnd,      ///< the mission has another number of ticks
  kZone,     ///< the team leaves a part of the domain, core/mission/zones.h
  kLaw,      ///< the law has another speed or other noise, core/mission/law_change.h
  kReopen,   ///< a zone is cancelled: it ends
  kDismiss,  ///< a contact is dismissed, core/mission/search_note.h
};
const char* to_string(AmendmentKind kind);

/// An amendment, as the list keeps it for people.
struct Amendment {
  std::int32_t number = 0;  ///< from 0
  AmendmentKind kind = AmendmentKind::kPause;
  Tick from = 0;  ///< the world's tick from which it holds
  /// kTarget: target_hash(); kEnd: the number of ticks; kZone: zone_hash(); kLaw: law_hash();
  /// kReopen: the number of the zone's amendment; kDismiss: search_note_hash(); else 0
  std::uint64_t hash = 0;
  std::string by{};  ///< its operator, as is_operator_name() allows; empty: not known
  /// The incarnation that sent its AMEND; 0: not known. One operator may send two alike.
  Incarnation ordered_by = 0;

  bool operator==(const Amendment&) const = default;
};

/// Limit (Team): length of the name of an amendment's operator [bytes]. Beyond it: commands cut it.
inline constexpr std::size_t kMaxOperatorNameLength = 32;
/// Whether this may be the name of an operator: at most kMaxOperatorNameLength printable ASCII
/// characters, also none.
bool is_operator_name(std::string_view name);
/// Makes a name of any text: other characters become '?', and it is cut.
std::string operator_name_of(std::string_view text);

/// A target that replaces the plan's from a tick on.
struct TargetChange {
  std::int32_t number = 0;  ///< of the amendment
  Tick from = 0;            ///< the world's tick from which it holds
  Coefficients target;      ///< μ in the mission's basis
  Coefficients cosine;      ///< with Basis::free_domain: μ in the basis (2), else empty

  /// μ in the basis (2), in any mission.
  const Coefficients& in_cosines() const { return cosine.size() > 0 ? cosine : target; }
  bool operator==(const TargetChange& other) const;
};

/// Another end of the mission, known from a tick on.
struct EndChange {
  std::int32_t number = 0;  ///< of the amendment
  Tick from = 0;            ///< the world's tick from which it holds
  Tick tick_count = 0;      ///< in the place of the plan's

  bool operator==(const EndChange&) const = default;
};

/// A number that identifies a target.
std::uint64_t target_hash(const TargetChange& change);

struct Amendments {
  /// How many amendments have been named: the number of the next one.
  std::int32_t named = 0;
  /// The newest kMaxRecentAmendments of all kinds, ascending by number.
  std::vector<Amendment> recent;
  /// All pauses.
  std::vector<Hold> holds;
  /// The newest targets, ascending by number. A coordinator keeps the two newest: no other one can
  /// hold at the present tick.
  std::vector<TargetChange> targets;
  /// All ends, ascending by number.
  std::vector<EndChange> ends;
  /// All zones that have not ended, ascending by number. They have places of their own, so that
  /// targets cannot crowd them out.
  std::vector<Zone> zones{};
  /// The newest laws, ascending by number; at most kMaxLaws, as of targets.
  std::vector<LawChange> laws{};
  /// All sightings and dismissals, ascending by number. A sighting has the number and the tick of
  /// its target. It leaves the list if another target takes its target's place.
  std::vector<SearchNote> notes{};

  bool empty() const {
    return named == 0 && holds.empty() && targets.empty() && ends.empty() && zones.empty() &&
           laws.empty() && notes.empty();
  }
  bool operator==(const Amendments&) const = default;
};

/// Limit (Team): amendments of a mission that its list names. Beyond it: the oldest are not listed;
/// they still hold.
inline constexpr std::size_t kMaxRecentAmendments = 32;
/// Limit (Team): amendments of a mission. Beyond it: `ergocast amend` and `ergocast pause` end with
/// code 4.
inline constexpr std::int32_t kMaxAmendments = 1'000'000;

/// Limit (Team): ends of a mission in the place of its plan's. Beyond it: `ergocast amend --end`
/// ends with code 4.
inline constexpr std::size_t kMaxEnds = 32;
/// The laws of a list: the one that holds, and the next.
inline constexpr std::size_t kMaxLaws = 2;

/// Whether a coordinator can have named this list for `mission`: are_holds(), numbers and ticks
/// ascend, each target is one of the mission's basis within limits (is_target()), ends have at
/// least one tick, zones are_zones(), laws are bounded_by_plan(), notes are_search_notes(), and
/// operators have names.
bool are_amendments(const Amendments& list, const Mission& mission);

/// Whether the numbers are a target of `mission`: as many as its basis has modes, finite, |μ| ≤ 1
/// up to rounding, and μ_00 = 1; and so in the basis (2), where the mission has one.
bool is_target(const Coefficients& target, const Coefficients& cosine, const Mission& mission);

/// The list of a mission that had only these pauses. @pre are_holds(holds)
Amendments only_pauses(std::vector<Hold> holds);

/// The target that holds at a tick of the world; null: the plan's.
const TargetChange* target_at(std::span<const TargetChange> targets, Tick tick);

/// How many ticks the mission has by the newest end: all processes go by it as soon as they know
/// it. No end is named for a tick that has passed.
inline Tick tick_count_of(const Timing& timing, std::span<const EndChange> ends) {
  return ends.empty() ? timing.tick_count : ends.back().tick_count;
}

// ---- for a coordinator ----

/// How many ticks before it takes effect a change is announced. Lockstep needs no notice: an agent
/// answers a tick only once it knows whether that tick counts.
Tick notice_ticks(const Timing& timing);

/// Names the next amendment, which pauses the mission or, if it is paused, resumes it.
/// @pre the list has room: named < kMaxAmendments, and holds.size() < kMaxHolds for a pause
void name_pause(Amendments& list, Tick tick);
/// Names the next amendment, a target. Its number and tick are set here.
void name_target(Amendments& list, Tick tick, TargetChange change);
/// Names the next amendment, a target that holds in the place of the newest one, from its tick on.
/// @pre the newest target does not hold yet
void replace_target(Amendments& list, TargetChange change);
/// Names the next amendment, an end. @pre the list has room: ends.size() < kMaxEnds
void name_end(Amendments& list, Tick tick, Tick tick_count);
/// Names the next amendment, a zone that is closed from `closed` on and free `notice` ticks later.
/// Zones that have ended at the present tick `now` leave the list.
/// @param zone  with `until` − `from` alone of its ticks
/// @pre now <= closed, and zones_at(list, now) < kMaxZones
void name_zone(Amendments& list, Tick now, Tick closed, Tick notice, Zone zone);
/// Names the next amendment, which ends a zone from a tick on, or when it closes if that is later.
/// @pre can_reopen(list, number, tick)
void name_reopening(Amendments& list, Tick tick, std::int32_t number);
/// Names the next amendment, a law. Its number and tick are set here.
void name_law(Amendments& list, Tick tick, LawChange change);
/// Names the next amendment, a law that holds in the place of the newest one, from its tick on.
/// @pre the newest law does not hold yet
void replace_law(Amendments& list, LawChange change);
/// The newest target follows from a sighting. Number and tick of the note are set here.
/// @pre the list has room: notes.size() < kMaxSearchNotes, and targets is not empty
void note_sighting(Amendments& list, SearchNote sighting);
/// Names the next amendment, a dismissal. Its number and tick are set here.
/// @pre the list has room: notes.size() < kMaxSearchNotes
void name_dismissal(Amendments& list, Tick tick, SearchNote dismissal);
/// Whether a zone of this number can be cancelled from a tick on: it has not been, and has not
/// ended by then.
bool can_reopen(const Amendments& list, std::int32_t number, Tick tick);
/// How many zones have not ended at a tick.
std::size_t zones_at(const Amendments& list, Tick tick);

// ---- for lists that keep all targets and zones, as a plan of amendments does ----

/// As name_target(); no older target leaves the list.
void add_target(Amendments& list, Tick tick, TargetChange change);
/// As name_zone(); no zone leaves the list.
void add_zone(Amendments& list, Tick closed, Tick notice, Zone zone);

}  // namespace ergocast
