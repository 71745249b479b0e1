// SPDX-License-Identifier: BSD-3-Clause
// A team as seen by a listening process: messages and time in, rows out. No clock, no I/O.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/ids.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast {

/// The condition of an agent, worst first.
enum class Condition {
  kSilent,   ///< has sent nothing for 3 s or more
  kWaiting,  ///< cannot continue without another process
  kLate,     ///< sends late, is behind the world, or its process is too slow
  kUnheard,  ///< not received yet, and we have not listened for long
  kOk,
  kFinished,  ///< has reported that it is done
  kGone,      ///< no longer a member, and without a successor
};

/// "silent", "waiting", "late", "not heard", "ok", "finished" or "gone".
const char* to_string(Condition condition);

/// The newest member under one number.
struct AgentRow {
  Author author;
  Condition condition = Condition::kOk;
  double silent_s = 0;  ///< since its last status, or since the listening began
  int restarts = 0;     ///< former incarnations in the roster
  std::optional<AgentStatus> status;
  Tick tick = 0;         ///< of its last status, the number among those that count
  std::string kind{};    ///< empty: its team has no kinds
  double blocked_s = 0;  ///< without a break, by a teammate's body or an edge, in mission time
  /// Its place in the newest state of the world: two numbers, in a box three; empty: not known.
  std::vector<double> position_m{};
  Tick position_tick = -1;  ///< of that state
  /// Its velocity there, in as many numbers.
  std::vector<double> velocity_mps{};
  std::int32_t charge_ppm = kNoCharge;  ///< of its battery, core/motion/charge.h
  /// Whether it moves in that state; nothing: not known.
  std::optional<bool> moves{};
  bool charges = false;  ///< its agent has gone home, and waits there for a full battery
};

/// Coordinator, world or logger.
struct ProcessRow {
  std::string name;
  bool heard = false;
  bool trouble = false;  ///< it should send and does not
  double silent_s = 0;
  Incarnation incarnation = 0;
  std::string host;  ///< empty: not known
  Tick tick = 0;     ///< of its last message, the number among those that count
};

struct TeamPicture {
  RunId run = 0;
  bool replay = false;                ///< sent by `ergocast replay`; no team runs
  bool authenticated = false;         ///< else any host on the network may have sent it
  std::string scenario;               ///< empty: MISSION was not received
  std::optional<MissionState> state;  ///< nothing: not received
  std::string reason;                 ///< why it ended, or why its plan cannot be read
  Tick tick = 0;                      ///< the world's, which continues in a pause
  Tick counted = 0, tick_count = 0;   ///< its number among those that count; 0: not known
  bool paused = false;                ///< `tick` does not count
  std::vector<Hold> holds;            ///< all that MISSION names
  std::optional<Amendment> target;    ///< which target holds at `tick`; nothing: the plan's
  std::optional<Amendment> end;       ///< the newest other end; nothing: the plan's
  std::vector<Zone> zones;            ///< those that are closed at `tick`
  std::optional<LawChange> law;       ///< which law holds at `tick`; nothing: the plan's
  std::string law_text;               ///< of that law
  double dt_s = 0;
  std::optional<double> ergodic_metric;  ///< median of the agents' values, in cosines or …
  bool free_domain = false;              ///< … in the modes of the free domain
  /// How likely an object drawn from the target has been found; nothing: no logger has reported it.
  std::optional<double> detection_probability;
  int objects = 0;                         ///< that the world hides, by the plan
  std::vector<Find> finds;                 ///< in their order, as a logger has reported them
  std::optional<int> wrong_confirmations;  ///< likewise, with false alarms
  std::vector<Contact> contacts;           ///< likewise, those that are confirmed first
  bool more_contacts = false;              ///< the logger may know others, which are less likely
  int agents_alive = 0, agents_expected = 0;
  std::int64_t missed_deadlines = 0, skipped_ticks = 0, clamped_commands = 0;
  std::vector<AgentRow> agents;  ///< worst first, then by number
  /// Agents whose coverage no longer counts or soon will not, ascending; see RosterEntry.
  std::vector<AgentId> forgotten;
  std::vector<ProcessRow> processes;
  /// Hosts whose agents ask to join with another version than `version`, this program's; filled by
  /// `ergocast status`.
  std::map<std::string, std::string> other_versions;
  std::string version;
  /// Browsers and programs that displays on this host serve; filled by the displays.
  std::vector<std::string> clients;
  bool trouble = false;
  bool over = false;  ///< the mission has ended: its processes exit or have exited
};

class TeamView {
 public:
  static constexpr Role kRole = Role::kMonitor;

  /// @param since  when the listening began
  /// @param authenticated  whether messages are checked with the team's key
  /// @param replay  whether `ergocast replay` sends it; then silence is measured in mission time
  TeamView(RunId run, Instant since, bool authenticated = false, bool replay = false);

  /// @pre the message is of this view's run
  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);

  TeamPicture picture(Instant now) const;

  /// Whether the mission, its processes and every member of its roster have been received.
  bool complete() const;
  /// Whether the coordinator, or all members, reported the mission's end.
  bool over() const;

 private:
  struct Seen {
    AgentStatus status;
    Instant tick_since{};
    double behind_s = 0;  ///< more than a tick behind the world, in wall time
  };

  template <class M>
  void on(const M&, const Arrival&) {}  // the other types need no more action
  void on(const AgentStatus& status, const Arrival& arrival);
  void on(const TeamStatus& team, const Arrival& arrival);
  void on(const WorldState& world, const Arrival& arrival);
  void on(const RecordAck& ack, const Arrival& arrival);
  const MissionFollower& follower() const { return me_.follower(); }
  Instant last_sign(const Author& author) const;
  AgentRow row_of(const Author& author, bool member, Instant now) const;
  void add_vehicle(AgentRow& row) const;
  static bool charges(const AgentRow& row, const Mission& mission, const Vehicle& vehicle);
  Condition condition_of(const Author& author, const Seen& seen, Instant now) const;
  std::map<AgentId, std::pair<Author, bool>> newest_incarnations() const;
  void add_agents(TeamPicture& picture, Instant now) const;
  void add_forgotten(TeamPicture& picture) const;
  void add_contacts(TeamPicture& picture) const;
  void add_process(TeamPicture& picture, AgentId sender, Instant now) const;
  bool should_report(AgentId sender) const;

  bool silent(const Author& author, const Seen& seen, Instant now) const;

  Participant me_;
  bool authenticated_, replay_;
  Instant since_;
  Tick tick_ = 0, world_tick_ = 0;
  std::map<Author, Seen> agents_;
  std::map<AgentId, Header> processes_;                   // the newest message of each
  std::map<AgentId, std::pair<Tick, Vehicle>> vehicles_;  // each one's newest state
  std::string coordinator_host_;
  std::optional<double> detection_probability_;  // from the newest RECORD_ACK
  int wrong_confirmations_ = 0;
  std::vector<Contact> contacts_;           // as it lists them
  bool more_contacts_ = false;              // the list is full
  std::vector<Find> finds_;                 // from the one with most
  std::optional<MissionState> team_state_;  // from TEAM_STATUS, which comes more often
  std::int64_t missed_deadlines_ = 0, skipped_ticks_ = 0, clamped_commands_ = 0, tick_count_ = 0;
  bool team_paused_ = false;  // from TEAM_STATUS
};

}  // namespace ergocast
