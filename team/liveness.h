// SPDX-License-Identifier: BSD-3-Clause
// Who is alive: the last fresh message of each life, and the one rule of silence.
//
// Whoever records messages can send them again, and a key does not prevent it. A repeat changes
// nothing by what it says. It must not keep the dead alive either, nor make anybody speak.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "core/ids.h"
#include "core/mission.h"
#include "team/messages.h"

namespace ergocast {

/// A sender is silent after so many heartbeats without a sign of life.
inline constexpr int kMissedHeartbeats = 6;

/// How a process that listens can tell that the coordinator lives.
enum class CoordinatorSign {
  kTeamStatus,  ///< by TEAM_STATUS, which nobody repeats
  kMission,     ///< by MISSION alone, also if a teammate repeats a part that was never heard
};

/// How often a sender of this kind speaks at least [wall time].
/// @param timing  of the mission, if it is known: a world in real time may speak once a tick only
PacingClock::duration heartbeat_of(AgentId sender, CoordinatorSign sign, const Timing* timing);

/// After how long without a sign of life a sender is silent: an agent, the world and the logger
/// after 3 s (the world in real time after six ticks if that is longer), the coordinator after 1.5 s
/// without TEAM_STATUS, or after 6 s without MISSION where TEAM_STATUS is not listened to.
PacingClock::duration silence_of(AgentId sender, CoordinatorSign sign = CoordinatorSign::kTeamStatus,
                                 const Timing* timing = nullptr);

/// How long after the mission's end, as far as the plan tells, a world or a coordinator may still
/// turn up that is started again [wall s].
inline constexpr double kFarewellPatience_s = 30;

/// Whether a running mission must be over, of whose world and coordinator nothing has been heard
/// for `silence`, and whose newest tick was `newest`. Whoever is cut off while the mission ends does
/// not hear of the end, and those who know of it are gone.
bool must_be_over(const Timing& timing, Tick newest, PacingClock::duration silence);

class Liveness {
 public:
  /// Takes in a message that its sender has transmitted itself.
  /// @param is_sign  whether it shows, if it is fresh, that its sender lives
  /// @return whether it is fresh: its sender has said nothing later yet, nor this, in this life and
  ///   on this bus. Of more than kMostLives lives, the later ones are never fresh.
  bool record(const Header& from, Bus bus, Instant now, bool is_sign = true);

  /// Takes it that a life lives at `now`, as one that has just been admitted does. It has a place even
  /// where strangers have filled the table; the caller bounds how many have.
  void presume_alive(const Author& life, Instant now);

  /// When the last sign of this life came.
  std::optional<Instant> last_sign(const Author& life) const;
  /// When the last sign of any life of this kind came; all agents are one kind.
  std::optional<Instant> last_sign_of_kind(AgentId sender) const { return kinds_[kind_of(sender)]; }

  /// The newest sequence of `life` on `bus`; −1 if nothing was heard.
  std::int64_t newest(const Author& life, Bus bus) const;
  /// How many of its messages are missing between the first and the newest that were heard.
  std::int64_t lost(const Author& life, Bus bus) const;

  /// Twice as many as a roster has room for: coordinators, worlds and loggers live more than once.
  static constexpr std::size_t kMostLives = 2 * kMaxRosterEntries;

 private:
  struct Heard {
    std::int64_t first = 0, newest = 0, count = 0;
  };
  struct Life {
    std::array<Heard, kBusCount> on_bus;
    std::optional<Instant> sign;
  };

  static std::size_t kind_of(AgentId sender) {
    return sender >= 0 ? 0 : static_cast<std::size_t>(-std::max(sender, kOperator));
  }
  Life* find_or_add(const Author& life);
  const Heard* heard_of(const Author& life, Bus bus) const;

  std::map<Author, Life> lives_;
  std::array<std::optional<Instant>, 1 - kOperator> kinds_;  // agents, then from kUnassigned down
};

}  // namespace ergocast
