// SPDX-License-Identifier: BSD-3-Clause
// A team as somebody sees it who only listens: messages and time in, rows out. No clock, no I/O.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast {

/// How an agent is doing, worst first.
enum class Condition {
  kSilent,   ///< has said nothing for 3 s or more
  kWaiting,  ///< stands still because of somebody else
  kLate,     ///< speaks late, is behind the world, or its process is too slow
  kUnheard,  ///< not heard yet, and we have not listened for long
  kOk,
  kFinished,  ///< has said that it is done
  kGone,      ///< no member any more, and nobody took its place
};

/// The newest member under one number.
struct AgentRow {
  Author author;
  Condition condition = Condition::kOk;
  double silent_s = 0;  ///< since its last status, or since we listen
  int restarts = 0;     ///< former incarnations in the roster
  std::optional<AgentStatus> status;
};

/// Coordinator, world or logger.
struct ProcessRow {
  std::string name;
  bool heard = false;
  bool trouble = false;  ///< it should speak and does not
  double silent_s = 0;
  Incarnation incarnation = 0;
  std::string host;  ///< empty: not known
  Tick tick = 0;     ///< of its last message
};

struct TeamPicture {
  RunId run = 0;
  bool authenticated = false;  ///< else anybody on the network may have said it
  std::string scenario;               ///< empty: the mission was not heard
  std::optional<MissionState> state;  ///< nothing: not heard
  std::string reason;                 ///< why it ended, or why its plan cannot be read
  Tick tick = 0, tick_count = 0;      ///< tick_count 0: not known
  double dt_s = 0;
  std::optional<double> ergodic_metric;  ///< median of what the agents see
  int agents_alive = 0, agents_expected = 0;
  std::int64_t missed_deadlines = 0, skipped_ticks = 0, clamped_commands = 0;
  std::vector<AgentRow> agents;  ///< worst first, then by number
  /// In ascending order: whose coverage counts no longer, or will soon not; see RosterEntry.
  std::vector<AgentId> forgotten;
  std::vector<ProcessRow> processes;
  bool trouble = false;
  bool over = false;  ///< the mission has ended: whoever was heard is leaving, or has left
};

class TeamView {
 public:
  static constexpr Role kRole = Role::kMonitor;

  /// @param since  when the listening began
  /// @param authenticated  whether what it receives was checked with the team's key
  TeamView(RunId run, Instant since, bool authenticated = false);

  /// @pre the message is of this view's run
  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);

  TeamPicture picture(Instant now) const;

  /// Whether the mission, its processes and every member of its roster have been heard.
  bool complete() const;
  /// Whether the mission has ended: the coordinator says so, or all its members do.
  bool over() const;

 private:
  struct Seen {
    AgentStatus status;
    Instant tick_since{};
    double behind_s = 0;  ///< more than a tick behind the world, in wall time
  };

  template <class M>
  void on(const M&, const Arrival&) {}  // nothing more follows from the other types
  void on(const AgentStatus& status, const Arrival& arrival);
  void on(const TeamStatus& team, const Arrival& arrival);
  void on(const WorldState& world, const Arrival& arrival);
  const MissionFollower& follower() const { return me_.follower(); }
  Instant last_sign(const Author& author) const;
  AgentRow row_of(const Author& author, bool member, Instant now) const;
  Condition condition_of(const Author& author, const Seen& seen, Instant now) const;
  std::map<AgentId, std::pair<Author, bool>> newest_lives() const;
  void add_agents(TeamPicture& picture, Instant now) const;
  void add_forgotten(TeamPicture& picture) const;
  void add_process(TeamPicture& picture, AgentId sender, Instant now) const;
  bool should_speak(AgentId sender) const;

  Participant me_;
  bool authenticated_;
  Instant since_;
  Tick tick_ = 0, world_tick_ = 0;
  std::map<Author, Seen> agents_;
  std::map<AgentId, Header> processes_;  // the newest of each
  std::string coordinator_host_;
  std::optional<MissionState> team_state_;  // as TEAM_STATUS has it, which comes more often
  std::int64_t missed_deadlines_ = 0, skipped_ticks_ = 0, clamped_commands_ = 0, tick_count_ = 0;
};

}  // namespace ergocast
