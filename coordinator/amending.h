// SPDX-License-Identifier: BSD-3-Clause
// Names the amendments of the mission: pauses, new targets, other ends, zones and their
// cancellation, other laws, sightings and dismissed contacts, each with the tick from which it
// holds (core/mission/amendments.h).
//
// All agents must change at the same tick. In lockstep the world first stands by: it stays at a
// tick until it knows which one is named. In real time the team gets notice.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/announcement.h"
#include "coordinator/members.h"
#include "coordinator/team_places.h"
#include "coordinator/tick_watch.h"
#include "core/mission/amendments.h"
#include "core/mission/mission.h"
#include "core/motion/end_rules.h"
#include "team/messages.h"

namespace ergocast {

class Amending {
 public:
  /// What is known of the team.
  struct Team {
    const SignsOfLife& signs;
    const TeamPlaces& places;
    const std::vector<RosterEntry>& roster;
  };

  const Amendments& list() const { return list_; }
  /// The list as MISSION carries it.
  const std::vector<std::byte>& bytes() const { return bytes_; }
  /// See MissionPart.
  std::int64_t stand_by_revision() const { return stand_by_revision_; }

  /// The amendments that are known from the beginning. In lockstep there may be any number of
  /// targets, zones and laws: the list has two targets, kMaxZones zones and kMaxLaws laws at a
  /// time, as if an operator had sent each once there was a place.
  /// @pre are_amendments(), but for the number of targets, zones and laws
  void plan(Amendments list);
  /// Takes in the list of another coordinator, if it has named more amendments than we know. Agents
  /// may have gone by them. @pre are_amendments(known)
  void adopt(const Amendments& known);
  /// Obeys a wish of the operator, once all its parts have arrived. It has no effect if it does not
  /// follow the newest amendment, or another one waits for its tick, or the list is full, or the
  /// content is none of `mission`, or no possible zone, or it would hold after the mission's end,
  /// or EndRules refuse it, or the tick of the world is unknown in real time.
  /// @pre the mission runs
  void obey(const Amend& amend, const Mission& mission, const TickWatch& ticks, const Team& team,
            Announcement& announcement);

  /// Names the next possible end if the mission has to end because objects are found
  /// (core/mission/end_by_finding.h).
  /// @param by_world  as many as the world knows of: in lockstep it stays at its tick by itself
  /// @param known     as many as any process knows of
  void note_found(int by_world, int known, const Mission& mission, const TickWatch& ticks,
                  const SignsOfLife& signs, Announcement& announcement);

  /// Lockstep: names a tick, or lists the next planned target, zone or law, if the world stands by.
  void note_world(const Mission& mission, const TickWatch& ticks, const Team& team,
                  Announcement& announcement);

 private:
  /// What an operator wants.
  struct Wish {
    AmendmentKind kind = AmendmentKind::kPause;
    Tick delay_ticks = 0;
    TargetChange target{};             // of kTarget
    Tick tick_count = 0;               // of kEnd; 0: as soon as possible
    Zone zone{};                       // of kZone
    LawChange law{};                   // of kLaw
    std::int32_t number = 0;           // of kReopen: the zone's
    std::optional<SearchNote> note{};  // of kDismiss, and of kTarget if it is a sighting
    std::string by{};                  // its operator
    Incarnation ordered_by = 0;
  };
  /// The parts of one AMEND that have arrived.
  struct Collected {
    Incarnation operator_incarnation = 0;
    std::int32_t number = -1;
    std::vector<std::optional<std::vector<std::byte>>> parts{};
  };

  bool may_name(const Amend& amend, const TickWatch& ticks) const;
  std::optional<Wish> wish_of(const Amend& amend, const Mission& mission, Tick now);
  bool possible(const Wish& wish, const Mission& mission, Tick newest, Tick from, const Team& team);
  std::optional<std::vector<std::byte>> completed(const Amend& amend);
  void stand_by(Announcement& announcement);
  void name(Tick now, Tick tick, Wish wish, Announcement& announcement);
  void list_wish(Tick now, Tick tick, Wish wish);
  bool target_is_due(Tick now) const;
  bool zone_is_due(Tick now) const;
  bool law_is_due(Tick now) const;
  void list_next(Tick now, Announcement& announcement);
  void replace(Amendments list);

  Amendments list_;
  std::vector<std::byte> bytes_;         // of list_
  std::vector<Collected> collected_;     // of the operators that asked last
  std::int64_t stand_by_revision_ = -1;  // lockstep: the tick of wish_ is to be named
  std::optional<Wish> wish_;
  EndRules end_rules_;
  std::deque<TargetChange> planned_;  // the targets that the list does not have yet
  std::deque<Zone> planned_zones_;    // the same of zones
  std::deque<LawChange> planned_laws_;
  // The last zone that was refused, and when, so that a repeated one costs no search.
  std::pair<std::vector<std::byte>, Tick> refused_zone_;
};

}  // namespace ergocast
