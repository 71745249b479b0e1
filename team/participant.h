// SPDX-License-Identifier: BSD-3-Clause
// The common part of every process of a mission. It decides which messages are accepted, and it
// knows the mission and its roster. It tracks which processes are alive, and numbers our own
// messages.
//
// Agent, coordinator, world, recorder, driver and the monitors each own one, and pass every message
// to accept() first. No socket, thread, clock or file.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/base/ids.h"
#include "team/command_window.h"
#include "team/liveness.h"
#include "team/messages.h"
#include "team/mission_follower.h"
#include "team/subscriptions.h"

namespace ergocast {

/// The identity under which a process sends.
struct Identity {
  RunId run = 0;                ///< 0: the run of the first MISSION received
  AgentId id = kUnassigned;     ///< an agent's number, or kCoordinator, kWorld …
  Incarnation incarnation = 0;  ///< random; 0 only if it never sends
};

/// What a receiver needs of a message besides its content.
struct Arrival {
  const Header& from;
  AgentId transmitter;  ///< the sender, or the agent that repeats the message
  Instant now;
  bool fresh = false;  ///< from its sender itself, and no later one arrived before; see Liveness
  bool mission_changed = false;  ///< it completed a newer revision of mission and roster
};

class Participant {
 public:
  Participant(Role role, const Identity& self) : role_(role), self_(self) {
    // Agents and loggers compute f.
    if (role == Role::kAgent || role == Role::kLogger) follower_.need_table();
  }

  /// The checks that all processes share. Returns nothing if our role has no subscription to the
  /// message on `bus`, or if the message is our own. It also returns nothing for a message of
  /// another run, which counts as Refusal::kRun. The same holds for a command of the operator that
  /// names an old tick, which counts as Refusal::kLate. While our run is 0, all runs pass, and the
  /// first MISSION sets it. An accepted message updates liveness and, if it is a MISSION, the
  /// follower. A foreign plan counts as Refusal::kRange.
  std::optional<Arrival> accept(const Message& message, Bus bus, AgentId transmitter, Instant now);

  // ---- the mission, as far as it is known ----
  const MissionFollower& follower() const { return follower_; }
  /// From now on accepts only this plan.
  /// @pre no part of the mission has been received
  void expect_plan(std::vector<std::byte> plan) { follower_.expect_plan(std::move(plan)); }
  /// @pre a whole plan has arrived and could be read
  const Mission& mission() const { return *follower_.mission(); }
  const Timing& timing() const { return mission().timing; }
  bool knows_mission() const { return follower_.mission().has_value(); }
  bool is_held(Tick tick) const { return ergocast::is_held(follower_.holds(), tick); }
  /// The number of a tick among those that count.
  Tick counted(Tick tick) const { return counted_ticks(follower_.holds(), tick); }
  /// How many ticks count by the newest end. @pre knows_mission()
  Tick tick_count() const { return tick_count_of(timing(), follower_.amendments().ends); }
  /// Whether `tick` is after the last one that counts. @pre knows_mission()
  bool is_over(Tick tick) const { return counted(tick) >= tick_count(); }
  /// The first tick for which is_over(), as far as it is known. @pre knows_mission()
  Tick end_tick() const { return tick_after(follower_.holds(), tick_count()); }
  /// The sender's roster entry if it is a present or former member under its own number; else null.
  const RosterEntry* member(const Header& from) const;

  // ---- the others ----
  const Liveness& liveness() const { return liveness_; }
  /// Counts an incarnation as alive at `now`; see Liveness.
  void presume_alive(const Author& author, Instant now) { liveness_.presume_alive(author, now); }
  /// Whether this incarnation has given no sign of life for six heartbeats, or never.
  bool silent(const Author& author, Instant now) const;
  /// The same for any incarnation of the coordinator, the world or the logger.
  /// @param since  when it should have started to send
  bool silent(AgentId process, Instant now, std::optional<Instant> since = {}) const;
  /// Whether the running mission must be over, because all processes that could report its end are
  /// silent. For the world these are coordinator and agents, for others coordinator and world.
  /// @param newest  the newest known tick
  bool cut_off(Tick newest, Instant now) const;
  /// Whether no member or former member will send again. Each incarnation in `roster` has then
  /// reported that it has finished, or is a silent former member.
  /// @param finished  whether an incarnation's last status reports that
  template <class F>
  bool team_has_left(const std::vector<RosterEntry>& roster, const F& finished, Instant now) const {
    return std::all_of(roster.begin(), roster.end(), [&](const RosterEntry& entry) {
      return finished(entry.author) || (entry.active_until >= 0 && silent(entry.author, now));
    });
  }

  // ---- ourselves ----
  Role role() const { return role_; }
  RunId run() const { return self_.run; }
  void set_run(RunId run) { self_.run = run; }
  AgentId id() const { return self_.id; }
  void set_id(AgentId id) { self_.id = id; }
  Incarnation incarnation() const { return self_.incarnation; }
  /// Continues under a new incarnation; the sequence numbers continue, too.
  void set_incarnation(Incarnation incarnation) { self_.incarnation = incarnation; }
  Author author() const { return {self_.id, self_.incarnation}; }

  /// We know that the mission has reached `tick`. publish() calls this, too.
  void note_tick(Tick tick) { own_tick_ = std::max(own_tick_, tick); }

  /// Appends `message` under our header and with the next sequence of `bus`.
  template <class M>
  void publish(Bus bus, const M& message, Tick tick, Outbox& out) {
    // Copies the message once, in place: a contribution is a kilobyte.
    Outgoing& outgoing = out.emplace_back();
    outgoing.bus = bus;
    if (!std::is_same_v<M, Hello>) note_tick(tick);  // a process that asks may not know it
    outgoing.message.emplace<M>(message).header = {
        self_.run, self_.id, self_.incarnation, ++sequences_[static_cast<std::size_t>(bus)], tick};
  }
  /// Appends another agent's message unchanged: we are only its transmitter.
  template <class M>
  void relay(Bus bus, const M& message, Outbox& out) const {
    Outgoing& outgoing = out.emplace_back();
    outgoing.bus = bus;
    outgoing.relayer = self_.id;
    outgoing.message.emplace<M>(message).header.run = self_.run;
  }

  void count_refused(Refusal refusal) { ++refused_[static_cast<std::size_t>(refusal)]; }
  const RefusalCounts& refused() const { return refused_; }
  std::int64_t refused(Refusal refusal) const {
    return refused_[static_cast<std::size_t>(refusal)];
  }
  /// Messages accepted, and published.
  std::int64_t received() const { return received_; }
  std::int64_t sent() const { return sequences_[0] + sequences_[1] + sequences_[2]; }

 private:
  CoordinatorSign coordinator_sign() const;
  void follow(const MissionPart& part, Arrival& arrival);
  bool too_late(const Message& message, Instant now);

  Role role_;
  Identity self_;
  MissionFollower follower_;
  Instant mission_heard_{};  // from any transmitter
  Liveness liveness_;
  Tick own_tick_ = -1;      // the newest that we have sent
  Tick mission_tick_ = -1;  // the newest that a MISSION named
  CommandWindow window_;
  std::array<std::int64_t, kBusCount> sequences_{};
  RefusalCounts refused_{};
  std::int64_t received_ = 0;
};

}  // namespace ergocast
