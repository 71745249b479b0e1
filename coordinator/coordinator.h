// SPDX-License-Identifier: BSD-3-Clause
// Admits agents, distributes the mission, starts, monitors and ends it. It never steers.
//
// It repeats its whole state once a second; a large state is repeated in turn. So none of its
// messages needs an acknowledgement. A restarted coordinator takes the mission over from the
// agents, which repeat it on request (takeover.cc). Admission is in admission.cc, pausing in
// pausing.cc.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/mission_pages.h"
#include "core/base/ids.h"
#include "core/mission/hold.h"
#include "core/mission/mission.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast {

/// The reaction of a coordinator to a mission that is already under way on its buses.
enum class Takeover {
  kNever,      ///< starts a mission of its own at once
  kIfRunning,  ///< listens for a moment; leaves if a coordinator leads the mission, else takes the
               ///< mission over, or starts its own if there is none
  kMust,       ///< takes over, also from a running coordinator, or fails
};

/// The state of a present or former member of the roster.
enum class MemberState { kAlive, kSilent, kGone };
const char* to_string(MemberState member_state);

/// How many ticks before it takes effect a change is announced. Lockstep needs no notice: an agent
/// answers a tick only once it knows whether that tick counts.
Tick notice_ticks(const Timing& timing);

struct CoordinatorIdentity {
  RunId run = 0;  ///< of its mission; 0, unless kNever: the run that is found, else `incarnation`
  Incarnation incarnation = 0;
  std::string host;
  std::string version;
};

class Coordinator {
 public:
  static constexpr Role kRole = Role::kCoordinator;

  /// @param plan  the encoded plan; may be empty with kMust, which accepts any mission
  Coordinator(CoordinatorIdentity identity, std::vector<std::byte> plan,
              Takeover takeover = Takeover::kNever);

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);
  void advance(Instant now, Outbox& out);
  Instant next_wakeup() const;

  /// Ends the mission in order; `failed` makes it a failure with that reason.
  void end(bool failed, std::string reason, Instant now);

  /// Plans the pauses of the mission from its beginning on. A simulation repeats recorded pauses
  /// so.
  /// @pre are_holds(holds), and it has not advanced
  void plan_holds(std::vector<Hold> holds) { holds_ = std::move(holds); }
  const std::vector<Hold>& holds() const { return holds_; }
  /// Whether the newest tick that it knows is held.
  bool paused() const { return is_held(holds_, world_.tick); }

  /// True once all others have reported that they leave, or the end has been repeated for 1 s.
  bool finished() const { return ending_.finished; }
  RunId run() const { return me_.run(); }
  /// Null until it has a mission; a takeover needs a moment to find one.
  const Mission* mission() const { return led_.mission ? &*led_.mission : nullptr; }
  /// Whether it still searches for a mission to take over.
  bool looking() const { return search_.takeover != Takeover::kNever; }
  /// Whether it took the mission over from a predecessor.
  bool took_over() const { return led_.taken_over; }
  /// Whether it has finished silently because another coordinator leads the mission or it cannot be
  /// taken over; see reason().
  bool left() const { return ending_.left; }
  MissionState state() const { return state_; }
  const std::string& reason() const { return ending_.reason; }
  const std::vector<RosterEntry>& roster() const { return roster_; }
  MemberState member_state(const RosterEntry& entry, Instant now) const;
  /// Hosts and versions of agents that were refused because their version differs from ours.
  const std::set<std::pair<std::string, std::string>>& version_mismatches() const {
    return newcomers_.version_mismatches;
  }
  /// Hosts of agents that were refused because the mission does not have their kind, and the
  /// sentence that says so.
  const std::set<std::pair<std::string, std::string>>& unknown_kinds() const {
    return newcomers_.unknown_kinds;
  }
  Tick tick() const { return world_.tick; }
  /// The operator's commands that were refused because their ticks are old.
  std::int64_t late_commands() const { return me_.refused(Refusal::kLate); }

 private:
  struct Name {
    std::string host, version;
  };
  /// The mission that it leads or will lead.
  struct LedMission {
    std::optional<Mission> mission;
    std::vector<std::byte> plan;  // as encoded
    bool taken_over = false;
  };
  /// The search for a mission that is under way. The follower holds the parts that agents repeat.
  struct MissionSearch {
    Takeover takeover;
    std::optional<Instant> since, found;
    Instant next_question{};
  };
  struct Revisions {
    std::int64_t current = 0;
    std::int64_t who_may_join = 0;  // the newest that affects all newcomers, …
    std::int64_t admits_from = -1;  // … and the one that a HELLO must know, once it was sent
  };
  struct Member {
    std::optional<AgentStatus> status;
    bool silence_reported = false;
    std::int64_t silence_revision = -1;  // of the revision that reports its last silence
  };
  struct Newcomers {
    std::map<Incarnation, Instant> asked;  // without a number: time of the first request
    std::map<Incarnation, Instant> heard;  // last HELLO of each process that is no member
    std::set<std::pair<std::string, std::string>> version_mismatches, unknown_kinds;
  };
  /// The newest information about the world.
  struct WorldSeen {
    bool heard = false, left = false;
    Tick tick = 0;
    Instant tick_since{};
    std::int64_t revision = 0;           // the roster revision of that tick
    std::int64_t newest_revision = 0;    // of any state, …
    std::optional<Instant> newer_since;  // … and since when it is newer than ours
    std::int64_t missed_deadlines = 0;
    std::map<AgentId, Tick> answered;
    Incarnation begun = 0;          // the incarnation that asked last for the team's state, …
    AgentId unheard = kUnassigned;  // … the agent that it waited for in that question, …
    Instant asked{};                // … and the time of the question
  };
  struct Schedule {
    std::optional<Instant> first;  // when it began to lead
    Instant next_mission{}, last_mission{}, next_team_status{};
  };
  struct Ending {
    std::optional<Instant> since;
    std::string reason;
    bool finished = false, left = false;
    bool logger_left = false;
  };

  template <class M>
  void on(const M&, const Arrival&) {}  // the other types need no action
  void on(const Hello& hello, const Arrival& arrival);
  void on_question(const Hello& question, const Arrival& arrival);
  void on(const AgentStatus& status, const Arrival& arrival);
  void on(const MissionPart& part, const Arrival& arrival);
  void on(const WorldState& world, const Arrival& arrival);
  void note_revision(const WorldState& world, Instant now);
  void on(const RecordAck& ack, const Arrival& arrival);
  void on(const TeamStatus& theirs, const Arrival& arrival);
  void on(const Stop& stop, const Arrival& arrival);
  void on(const Pause& pause, const Arrival& arrival);
  const Timing& timing() const { return led_.mission->timing; }
  Tick end_tick() const { return tick_after(holds_, timing().tick_count); }
  bool may_change_holds() const;
  void name_tick(Tick tick);
  void name_tick_with_notice(Instant now);
  Instant last_sign(const Author& author) const;
  void admit(const Author& author, int kind, Instant now);
  void note_stranger(Incarnation incarnation, Instant now);
  bool everybody_left(Instant now) const;
  bool may_have_stopped(Instant since, Instant now) const;
  std::optional<AgentId> free_id(Incarnation newcomer, const std::string& kind, Instant now);
  RosterEntry* active_entry(AgentId id);
  bool alive(const RosterEntry& entry, Instant now) const;
  int alive_count(Instant now) const;
  void look_for_mission(Instant now, Outbox& out);
  std::optional<std::string> not_ours(Instant now) const;
  void take_over(Instant now);
  Instant end_of_search() const;
  Instant next_look() const;
  bool other_coordinator_alive(Instant now) const;
  bool other_coordinator_leads(Instant now) const;
  std::string led_by_other_coordinator() const;
  void leave(std::string reason, Instant now);
  void begin_own();
  void supersede_dead_coordinator(Instant now);
  void lead(Instant now, Outbox& out);
  void note_silences(Instant now);
  void review_coverage(Instant now);
  bool may_switch(const RosterEntry& entry) const;
  void switch_coverage(RosterEntry& entry, bool forgotten);
  void check_admission(Instant now);
  void check_tick(Instant now);
  AgentId waits_for(const RosterEntry& entry) const;
  RosterEntry* straggler(Instant now);
  void announce() { publish_anew(), revisions_.who_may_join = revisions_.current; }
  void publish_anew() { ++revisions_.current, schedule_.next_mission = Instant{}; }
  /// For any change but an admission. A newcomer must know the new revision, so that no recording
  /// is admitted.
  void change() { announce(), revisions_.admits_from = revisions_.current; }
  void repeat_mission_soon();
  std::vector<MissionPart> mission_parts() const;
  void publish_mission(Outbox& out);
  void publish_team_status(Instant now, Outbox& out);

  Participant me_;
  Name name_;
  LedMission led_;
  MissionSearch search_;
  std::optional<TeamStatus> other_coordinator_;  // another coordinator's
  MissionState state_ = MissionState::kWaiting;
  std::vector<RosterEntry> roster_;
  std::vector<Hold> holds_;
  std::int64_t stand_by_revision_ = -1;       // lockstep: the next tick of holds_ is to be named
  std::map<Author, std::size_t> admissions_;  // the place of each entry in MISSION
  MissionPages pages_;
  Revisions revisions_;
  std::map<Author, Member> members_;
  Newcomers newcomers_;
  WorldSeen world_;
  Tick team_tick_ = 0;    // the newest of any agent
  Instant deaf_until_{};  // it received no message
  Schedule schedule_;
  Ending ending_;
};

}  // namespace ergocast
