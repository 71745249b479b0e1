// SPDX-License-Identifier: BSD-3-Clause
// What every process of a mission has in common: which messages it accepts, what it knows of the
// mission and of its roster, who is alive, and how its own messages are numbered.
//
// Agent, coordinator, world, recorder, driver and the monitors each own one, and ask accept() first
// of every message. No socket, thread, clock or file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "core/ids.h"
#include "team/liveness.h"
#include "team/messages.h"
#include "team/mission_follower.h"
#include "team/subscriptions.h"

namespace ergocast {

/// Under which name a process speaks.
struct Identity {
  RunId run = 0;                ///< 0: the run of the first MISSION heard
  AgentId id = kUnassigned;     ///< an agent's number, or kCoordinator, kWorld …
  Incarnation incarnation = 0;  ///< random; 0 only for who never speaks
};

/// What a receiver has to know about a message besides its content.
struct Arrival {
  const Header& from;
  AgentId transmitter;  ///< the sender, or the agent that repeats the message
  Instant now;
  bool fresh = false;  ///< it came from its sender, who has said nothing later yet; see Liveness
  bool mission_changed = false;  ///< it completed a newer revision of mission and roster
};

class Participant {
 public:
  Participant(Role role, const Identity& self) : role_(role), self_(self) {}

  /// The checks that all processes share. Nothing if the message is of a type that our role does not
  /// hear on `bus`, our own, or of another run, which is counted as Refusal::kRun. While our run is
  /// 0, all runs pass, and the first MISSION sets it. Otherwise liveness has learnt of the message,
  /// and from MISSION the follower; a plan that is not this run's is counted as Refusal::kRange.
  std::optional<Arrival> accept(const Message& message, Bus bus, AgentId transmitter, Instant now);

  // ---- the mission, as far as it is known ----------------------------------------------------------
  const MissionFollower& follower() const { return follower_; }
  /// From now on takes no other plan than this one.
  /// @pre no part of the mission has been received
  void expect_plan(std::vector<std::byte> plan) { follower_.expect_plan(std::move(plan)); }
  /// @pre a whole plan has arrived and could be read
  const Mission& mission() const { return *follower_.mission(); }
  const Timing& timing() const { return mission().timing; }
  bool knows_mission() const { return follower_.mission().has_value(); }
  /// The roster's entry of the sender if that is a member, present or former, under its own number;
  /// else null.
  const RosterEntry* member(const Header& from) const;

  // ---- the others --------------------------------------------------------------------------------
  const Liveness& liveness() const { return liveness_; }
  /// Takes it that a life lives at `now`; see Liveness.
  void presume_alive(const Author& life, Instant now) { liveness_.presume_alive(life, now); }
  /// Whether this life has given no sign for six heartbeats, or never.
  bool silent(const Author& life, Instant now) const;
  /// The same of any life of the coordinator, the world or the logger.
  /// @param since  from when on it should speak
  bool silent(AgentId process, Instant now, std::optional<Instant> since = {}) const;
  /// Whether the running mission must be over: nobody who could tell us has spoken for so long; to a
  /// world that is coordinator and agents, to everybody else coordinator and world.
  /// @param newest  tick that is known
  bool cut_off(Tick newest, Instant now) const;

  // ---- ourselves ---------------------------------------------------------------------------------
  Role role() const { return role_; }
  RunId run() const { return self_.run; }
  void set_run(RunId run) { self_.run = run; }
  AgentId id() const { return self_.id; }
  void set_id(AgentId id) { self_.id = id; }
  Incarnation incarnation() const { return self_.incarnation; }
  /// A process that goes on as another life of itself. Its sequences go on, too.
  void set_incarnation(Incarnation incarnation) { self_.incarnation = incarnation; }
  Author author() const { return {self_.id, self_.incarnation}; }

  /// Appends `message` under our header and with the next sequence of `bus`.
  template <class M>
  void publish(Bus bus, const M& message, Tick tick, Outbox& out) {
    // Copied once, into its place: a contribution is a kilobyte.
    Outgoing& outgoing = out.emplace_back();
    outgoing.bus = bus;
    outgoing.message.emplace<M>(message).header = {
        self_.run, self_.id, self_.incarnation, ++sequences_[static_cast<std::size_t>(bus)], tick};
  }
  /// Appends somebody else's block as its author said it: we are only the transmitter.
  void relay(Bus bus, const Contribution& block, Outbox& out) const;

  void count_refused(Refusal refusal) { ++refused_[static_cast<std::size_t>(refusal)]; }
  const RefusalCounts& refused() const { return refused_; }
  std::int64_t refused(Refusal refusal) const { return refused_[static_cast<std::size_t>(refusal)]; }
  /// Messages accepted, and published.
  std::int64_t received() const { return received_; }
  std::int64_t sent() const { return sequences_[0] + sequences_[1] + sequences_[2]; }

 private:
  CoordinatorSign coordinator_sign() const;
  void follow(const MissionPart& part, Arrival& arrival);

  Role role_;
  Identity self_;
  MissionFollower follower_;
  Instant mission_heard_{};  // by whomever it was said
  Liveness liveness_;
  std::array<std::int64_t, kBusCount> sequences_{};
  RefusalCounts refused_{};
  std::int64_t received_ = 0;
};

}  // namespace ergocast
