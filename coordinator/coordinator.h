// SPDX-License-Identifier: BSD-3-Clause
// Admits agents, distributes the mission, starts, watches and ends it. Never steers.
//
// It repeats its whole state once a second, so that none of its messages needs an acknowledgement.
// A restarted coordinator takes the mission over from the agents, which repeat it on request
// (takeover.cc). Who may join is in admission.cc.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/ids.h"
#include "team/messages.h"
#include "core/mission.h"
#include "team/participant.h"

namespace ergocast {

/// What a coordinator does about a mission that is already under way on its buses.
enum class Takeover {
  kNever,     ///< starts a mission of its own at once
  kIfRunning,  ///< listens for a moment; takes over what nobody leads, leaves to a living coordinator
              ///< what it leads, or starts its own
  kMust,      ///< takes over, also from a living coordinator, or fails
};

/// How a member of the roster, present or former, is doing.
enum class Presence { kAlive, kSilent, kGone };
const char* to_string(Presence presence);

struct CoordinatorIdentity {
  RunId run = 0;  ///< its mission's; 0, unless kNever: whichever is flying, else `incarnation`
  Incarnation incarnation = 0;
  std::string host;
  std::string version;
};

class Coordinator {
 public:
  static constexpr Role kRole = Role::kCoordinator;

  /// @param plan  the compiled plan as it travels; may be empty with kMust: any mission's
  Coordinator(CoordinatorIdentity identity, std::vector<std::byte> plan,
              Takeover takeover = Takeover::kNever);

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);
  void advance(Instant now, Outbox& out);
  Instant next_wakeup() const;

  /// Ends the mission in order; `failed` makes it a failure with that reason.
  void end(bool failed, std::string reason, Instant now);

  /// True once the end has been repeated for long enough.
  bool finished() const { return ending_.finished; }
  RunId run() const { return me_.run(); }
  /// Null until it has one, which with a takeover takes a moment.
  const Mission* mission() const { return flown_.mission ? &*flown_.mission : nullptr; }
  /// Whether it has yet to find out if there is a mission to take over.
  bool looking() const { return search_.takeover != Takeover::kNever; }
  /// Whether it took the mission over from a predecessor.
  bool took_over() const { return flown_.taken_over; }
  /// Whether it has finished without a word because the mission is not its to lead; reason() says why.
  bool left() const { return ending_.left; }
  MissionState state() const { return state_; }
  const std::string& reason() const { return ending_.reason; }
  const std::vector<RosterEntry>& roster() const { return roster_; }
  Presence presence(const RosterEntry& entry, Instant now) const;
  /// Hosts and versions of agents that were not admitted because their version is not ours.
  const std::set<std::pair<std::string, std::string>>& strangers() const { return newcomers_.strangers; }
  Tick tick() const { return world_.tick; }

 private:
  struct Name {
    std::string host, version;
  };
  /// What it leads, or is to lead.
  struct Flown {
    std::optional<Mission> mission;
    std::vector<std::byte> plan;  // as it travels
    bool taken_over = false;
  };
  /// How it finds a mission that is under way, until it leads one; the follower has what agents say.
  struct MissionSearch {
    Takeover takeover;
    std::optional<Instant> since, found;
    Instant next_question{};
  };
  struct Revisions {
    std::int64_t current = 0;
    std::int64_t who_may_join = 0;  // the newest that bears on all newcomers, …
    std::int64_t admits_from = -1;  // … and what a HELLO must know of, once it was said
  };
  struct Member {
    std::optional<AgentStatus> status;
    bool silence_said = false;
    std::int64_t silence_revision = -1;  // that tells of its last silence
  };
  struct Newcomers {
    std::map<Incarnation, Instant> asked;  // without a number: since when
    std::set<std::pair<std::string, std::string>> strangers;
  };
  /// The newest that was heard of the world.
  struct WorldSeen {
    bool heard = false;
    Tick tick = 0;
    Instant tick_since{};
    std::int64_t revision = 0;  // of the roster that the tick is flown by
    std::int64_t missed_deadlines = 0;
    std::map<AgentId, Tick> answered;
    Incarnation begun = 0;         // the life that asked last where the team is, …
    AgentId unheard = kUnassigned; // … whose answer it waited for when it asked last, …
    Instant asked{};               // … and when that was
  };
  struct Said {
    std::optional<Instant> first;  // when it began to lead
    Instant next_mission{}, last_mission{}, next_team_status{};
  };
  struct Ending {
    std::optional<Instant> since;
    std::string reason;
    bool finished = false, left = false;
  };

  template <class M>
  void on(const M&, const Arrival&) {}  // nothing follows from the other types
  void on(const Hello& hello, const Arrival& arrival);
  void on_question(const Hello& question, const Arrival& arrival);
  void on(const AgentStatus& status, const Arrival& arrival);
  void on(const MissionPart& part, const Arrival& arrival);
  void on(const WorldState& world, const Arrival& arrival);
  void on(const TeamStatus& theirs, const Arrival& arrival);
  void on(const Stop& stop, const Arrival& arrival);
  const Timing& timing() const { return flown_.mission->timing; }
  Instant last_sign(const Author& author) const;
  void admit(const Author& author, Instant now);
  bool doubtful(Instant since, Instant now) const;
  std::optional<AgentId> free_id(Incarnation newcomer, Instant now);
  RosterEntry* active_entry(AgentId id);
  bool alive(const RosterEntry& entry, Instant now) const;
  int alive_count(Instant now) const;
  void look_for_mission(Instant now, Outbox& out);
  std::optional<std::string> not_ours(Instant now) const;
  void take_over(Instant now);
  Instant next_look() const;
  bool rival_lives(Instant now) const;
  bool rival_leads(Instant now) const;
  std::string led_by_rival() const;
  void leave(std::string reason, Instant now);
  void begin_own();
  void lead(Instant now, Outbox& out);
  void note_silences(Instant now);
  void review_coverage(Instant now);
  bool may_switch(const RosterEntry& entry) const;
  void switch_coverage(RosterEntry& entry, bool forgotten);
  void check_admission(Instant now);
  void check_tick(Instant now);
  AgentId waits_for(const RosterEntry& entry) const;
  RosterEntry* culprit(Instant now);
  void announce() { say_anew(), revisions_.who_may_join = revisions_.current; }
  void say_anew() { ++revisions_.current, said_.next_mission = Instant{}; }
  /// Anything but an admission: newcomers have to know of it, so that no recording of one gets in.
  void change() { announce(), revisions_.admits_from = revisions_.current; }
  void repeat_mission_soon();
  void publish_mission(Outbox& out);
  void publish_team_status(Instant now, Outbox& out);

  Participant me_;
  Name name_;
  Flown flown_;
  MissionSearch search_;
  std::optional<TeamStatus> rival_;  // another coordinator's
  MissionState state_ = MissionState::kWaiting;
  std::vector<RosterEntry> roster_;
  Revisions revisions_;
  std::map<Author, Member> members_;
  Newcomers newcomers_;
  WorldSeen world_;
  Tick team_tick_ = 0;    // the newest of any agent
  Instant deaf_until_{};  // it heard nobody
  Said said_;
  Ending ending_;
};

}  // namespace ergocast
