// Admits agents, distributes the mission, starts, watches and ends it. Never steers.
//
// It repeats its whole state once a second, so that nothing it says needs an acknowledgement. One
// that is restarted takes the mission over from the agents, who repeat it to whoever asks.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "team/freshness.h"
#include "core/ids.h"
#include "team/messages.h"
#include "core/mission.h"
#include "team/mission_follower.h"

namespace ergocast {

/// What a coordinator does about a mission that is already under way on its buses.
enum class Takeover {
  kNever,     ///< starts a mission of its own at once
  kIfFlying,  ///< listens for a moment; takes over what nobody leads, leaves to a living coordinator
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
  /// @param plan  the compiled plan as it travels; may be empty with kMust: any mission's
  Coordinator(CoordinatorIdentity identity, std::vector<std::byte> plan,
              Takeover takeover = Takeover::kNever);

  void receive(const Message& message, Instant now);
  void advance(Instant now, Outbox& out);
  Instant next_wakeup() const;

  /// Ends the mission in order; `failed` makes it a failure with that reason.
  void end(bool failed, std::string reason, Instant now);

  /// True once the end has been repeated for long enough.
  bool finished() const { return finished_; }
  RunId run() const { return run_; }
  /// Null until it has one, which with a takeover takes a moment.
  const Mission* mission() const { return mission_ ? &*mission_ : nullptr; }
  /// Whether it has yet to find out if there is a mission to take over.
  bool looking() const { return takeover_ != Takeover::kNever; }
  /// Whether it took the mission over from a predecessor.
  bool took_over() const { return took_over_; }
  /// Whether it has finished without a word because the mission is not its to lead; reason() says why.
  bool left() const { return left_; }
  MissionState state() const { return state_; }
  const std::string& reason() const { return reason_; }
  const std::vector<RosterEntry>& roster() const { return roster_; }
  Presence presence(const RosterEntry& entry, Instant now) const;
  /// Hosts and versions of agents that were not admitted because their version is not ours.
  const std::set<std::pair<std::string, std::string>>& strangers() const { return strangers_; }
  Tick tick() const { return tick_; }

 private:
  struct Member {
    std::optional<AgentStatus> status;
    Instant heard{};
    bool silence_said = false;
    std::int64_t silence_revision = -1;  // that tells of its last silence
  };

  void on(const Hello& hello, Instant now);
  void on(const AgentStatus& status, Instant now);
  void on(const MissionPart& part, Instant now);
  void on(const WorldState& world, Instant now);
  void on(const TeamStatus& theirs, Instant now);
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
  void announce() { say_anew(), who_may_join_ = revision_; }
  void say_anew() { ++revision_, next_mission_ = Instant{}; }
  /// Anything but an admission: newcomers have to know of it, so that no recording of one gets in.
  void change() { announce(), admits_from_ = revision_; }
  void publish_mission(Outbox& out);
  void publish_team_status(Instant now, Outbox& out);
  Header header(Bus bus);

  RunId run_;
  Incarnation incarnation_;
  std::string host_, version_;
  std::set<std::pair<std::string, std::string>> strangers_;
  std::optional<Mission> mission_;
  std::vector<std::byte> plan_;
  MissionFollower follower_;  // what agents say of a mission under way
  Takeover takeover_;
  bool took_over_ = false, left_ = false;
  std::optional<Instant> looking_since_, found_;
  Tick team_tick_ = 0;  // the newest of any agent
  std::optional<TeamStatus> rival_;  // another coordinator's
  Instant rival_heard_{};
  Freshness freshness_;
  Instant next_question_{};
  Sequencer sequencer_;

  MissionState state_ = MissionState::kWaiting;
  std::string reason_;
  std::int64_t revision_ = 0;
  std::int64_t who_may_join_ = 0;  // the newest revision that bears on all newcomers, …
  std::int64_t admits_from_ = -1;  // … and what a HELLO must know of, once it was said
  std::vector<RosterEntry> roster_;
  std::map<Author, Member> members_;
  std::map<Incarnation, Instant> asked_;  // newcomers without a number: since when
  std::map<AgentId, std::int64_t> answered_;  // by the world's word

  bool world_heard_ = false;
  Tick tick_ = 0;
  std::int64_t world_revision_ = 0;  // of the roster that tick_ is flown by
  Instant deaf_until_{};             // it heard nobody
  std::int64_t missed_deadlines_ = 0;
  std::optional<Instant> started_, ended_;
  Instant tick_since_{};
  Instant next_mission_{}, last_mission_{}, next_team_status_{};
  bool finished_ = false;
};

}  // namespace ergocast
