// SPDX-License-Identifier: BSD-3-Clause
// Decides which processes are alive: the last fresh message of each incarnation, and one rule of
// silence.
//
// An attacker can record messages and replay them; a key does not prevent this. A replay is no sign
// of life and gets no answer.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "team/author_map.h"
#include "team/messages.h"

namespace ergocast {

/// A sender is silent after so many heartbeats without a sign of life.
/// Limit (Time): heartbeats that a process may miss. Beyond it: the process counts as silent.
inline constexpr int kMissedHeartbeats = 6;

/// How a listening process detects that the coordinator is alive.
enum class CoordinatorSign {
  kTeamStatus,  ///< by TEAM_STATUS, which no process repeats
  kMission,     ///< by MISSION alone, also if a teammate repeats a part not received before
};

/// The longest time between two messages of this kind of sender [wall time].
/// @param timing  of the mission, if known: a world in real time may send only once a tick
PacingClock::duration heartbeat_of(AgentId sender, CoordinatorSign sign, const Timing* timing);

/// The time without a sign of life after which a sender is silent. It is 3 s for an agent, the
/// world and the logger. For a world in real time it is six ticks if that is longer. The
/// coordinator is silent after 1.5 s without TEAM_STATUS, or after 6 s without MISSION for a
/// process without a subscription to TEAM_STATUS.
PacingClock::duration silence_of(AgentId sender,
                                 CoordinatorSign sign = CoordinatorSign::kTeamStatus,
                                 const Timing* timing = nullptr);

/// How long after the planned end a restarted world or coordinator may still appear [wall s].
inline constexpr double kFarewellPatience_s = 30;

/// Whether a running mission must be over. If so, a process that was disconnected when it ended
/// stops by itself: the others have exited and send nothing.
/// @param newest  the count of the newest tick
/// @param silence  how long nothing was received from world and coordinator
bool must_be_over(const Timing& timing, Tick newest, PacingClock::duration silence);

class Liveness {
 public:
  /// Records a message that its sender has transmitted itself.
  /// @param is_sign  whether it is a sign of life if it is fresh
  /// @return whether it is fresh: its sender has sent neither this nor a later message in this
  ///   incarnation on this bus. Messages of incarnations beyond kMaxIncarnations are never fresh.
  bool record(const Header& from, Bus bus, Instant now, bool is_sign = true);

  /// Counts an incarnation as alive at `now`, for example after its admission. It gets a place even
  /// in a full table; the caller limits how many such incarnations there are.
  void presume_alive(const Author& author, Instant now);

  /// The time of the last sign of this incarnation.
  std::optional<Instant> last_sign(const Author& author) const;
  /// The time of the last sign of any incarnation of this kind; all agents are one kind.
  std::optional<Instant> last_sign_of_kind(AgentId sender) const { return kinds_[kind_of(sender)]; }

  /// The newest sequence of `author` on `bus`; −1 if nothing was received.
  std::int64_t newest(const Author& author, Bus bus) const;
  /// How many of its messages are missing between the first and the newest one received.
  std::int64_t lost(const Author& author, Bus bus) const;

  /// Twice the size of a roster: coordinators, worlds and loggers may have several incarnations.
  /// Limit (Team): incarnations of any process that a process tells apart. Beyond it: messages of
  /// others count as silence.
  static constexpr std::size_t kMaxIncarnations = 2 * kMaxRosterEntries;

 private:
  struct Received {
    std::int64_t first = 0, newest = 0, count = 0;
  };
  struct Seen {
    std::array<Received, kBusCount> on_bus;
    std::optional<Instant> sign;
  };

  static std::size_t kind_of(AgentId sender) {
    return sender >= 0 ? 0 : static_cast<std::size_t>(-std::max(sender, kOperator));
  }
  Seen* find_or_add(const Author& author);
  const Received* received_from(const Author& author, Bus bus) const;

  AuthorMap<Seen> incarnations_;
  std::array<std::optional<Instant>, 1 - kOperator> kinds_;  // agents, then from kUnassigned down
};

}  // namespace ergocast
