// SPDX-License-Identifier: BSD-3-Clause
// Sends MISSION. It numbers the revisions, and decides when the next repetition is due.
//
// A change is sent at once, and the whole is repeated once a second. A process that lacks the
// newest revision may have it repeated sooner. The end is repeated ten times a second.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "coordinator/members.h"
#include "coordinator/part_schedule.h"
#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast {

/// The content of MISSION. See MissionPart.
struct MissionContent {
  MissionState state;
  const std::string& reason;
  const std::vector<std::byte>& plan;
  const Members& members;
  const std::vector<std::byte>& amendments;  ///< as encoded
  std::int64_t stand_by_revision;
};

class Announcement {
 public:
  /// The newest revision.
  std::int64_t revision() const { return revision_; }
  /// The revision that a HELLO must know, so that no recording is admitted.
  std::int64_t admits_from() const { return admits_from_; }

  // ---- a new revision, which is sent at once ----
  /// For the silence of a member, which matters only to a newcomer under its number.
  void note_silence();
  /// For an admission. Newcomers must know the new revision once it was sent.
  void note_admission();
  /// For any other change. Newcomers must know the new revision from now on.
  void change();
  /// A change whose revision exceeds `revision`, which another coordinator has used.
  void exceed(std::int64_t revision);

  /// The first revision after a takeover. @pre nothing was sent yet
  void continue_from(std::int64_t revision);

  // ---- repetitions ----
  Instant next() const { return next_; }
  /// A process lacks the newest revision. Repetitions for this reason keep a distance in time, so
  /// that HELLO messages cannot flood the bus.
  void repeat_soon();
  /// Sends the parts that PartSchedule names, on the buses swarm and command.
  /// @param tick  the newest of the world
  void publish(const MissionContent& mission, Participant& me, Tick tick, Outbox& out);
  /// Plans the next repetition after one at `now`.
  /// @param over  whether the mission is over
  void plan_next(bool over, Instant now);

 private:
  std::vector<MissionPart> parts_of(const MissionContent& mission) const;

  std::int64_t revision_ = 0;
  std::int64_t who_may_join_ = 0;  // the newest that affects all newcomers, …
  std::int64_t admits_from_ = -1;  // … and the one that a HELLO must know, once it was sent
  Instant next_{}, last_{};
  PartSchedule schedule_;
};

}  // namespace ergocast
