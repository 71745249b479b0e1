// SPDX-License-Identifier: BSD-3-Clause
// A running team as frames for the page: messages and log lines in, JSON out. No clock, no I/O.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cli/team/agent_history.h"
#include "cli/team/amendment_history.h"
#include "cli/team/team_history.h"
#include "cli/team/team_view.h"
#include "core/mission/mission.h"
#include "report/target_density.h"
#include "report/track_grid.h"
#include "team/participant.h"

namespace ergocast {

/// Everything is kept once, up to limits, and each browser has a cursor into it. A slow browser
/// gets what it missed later and uses no extra memory. Not thread-safe.
class LiveTeam {
 public:
  static constexpr Role kRole = Role::kPage;
  /// Limit (Page): log lines on the page. Beyond it: the oldest is removed.
  static constexpr std::size_t kMostLines = 400;
  /// Limit (Page): incidents on the page. Beyond it: the oldest is removed.
  static constexpr std::size_t kMostIncidents = 500;

  /// @param since  when the listening began
  /// @param authenticated  whether messages are checked with the team's key
  /// @param replay  whether `ergocast replay` sends it
  LiveTeam(RunId run, Instant since, bool authenticated, bool replay = false);

  /// Sets mission and target density if they are known before the first message.
  void begin(const Mission& mission, const Field& density);

  /// @pre the message is of this view's run
  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);
  void log(std::string line);
  /// Browsers and programs that displays on this host serve.
  void name_clients(std::vector<std::string> clients) { clients_ = std::move(clients); }
  /// Looks for incidents; call it a few times a second. Returns the picture that it examined.
  TeamPicture notice(Instant now);
  /// Does the same, and keeps the agents' statuses for the browsers.
  TeamPicture look(Instant now);
  /// [{"t", "kind", "sign", "text", "agent", "until"}, …] as the page gets them. The last two keys
  /// are there only if known.
  nlohmann::ordered_json incidents_json() const;

  RunId run() const { return me_.run(); }
  const MissionFollower& follower() const { return me_.follower(); }
  /// Null until it is received.
  const Mission* mission() const { return me_.knows_mission() ? &me_.mission() : nullptr; }
  /// Whether the mission's end was reported.
  bool over() const { return view_.over(); }
  const std::string& end_text() const { return end_text_; }

  /// What a browser has received so far.
  struct Cursor {
    Tick stride = 0;  ///< of the rows; when it grows, the browser starts again
    std::int64_t row = 0;
    std::uint64_t statuses = 0, incidents = 0, rosters = 0, lines = 0;
    AmendmentHistory::Cursor amendments{};
  };
  /// The next server-sent events for that browser; empty if there is nothing new. One call returns
  /// a bounded number of rows; `more` is set if others wait.
  std::string frame(Cursor& cursor, bool& more) const;

 private:
  struct Incident {
    double t_s = 0;
    const char* kind;  ///< "silent", "gone", "late" or "ok"
    const char* sign;
    std::string text;
    std::optional<AgentId> agent;
    std::optional<double> until_s;
  };
  struct LastLook {
    Condition condition = Condition::kUnheard;
    Incarnation incarnation = 0;
    double heard_s = 0;  ///< mission time of its last status
  };

  template <class M>
  void on(const M&) {}  // the other types need no more action
  void on(const WorldState& world);
  void on(const Command& command);
  void on(const MissionPart& part);
  bool joined_late(const Author& author) const;
  void note_recalls();
  void note_holds(Tick tick, double dt_s);
  void compare(const AgentRow& row, double t_s, double dt_s);
  void compare(const ProcessRow& row, double t_s);
  void add_incident(Incident incident);
  void close_outage(const std::string& of, double t_s);
  nlohmann::ordered_json roster_json() const;
  nlohmann::ordered_json commands_json() const;

  Participant me_;
  TeamView view_;
  bool authenticated_, replay_;
  std::optional<TrackGrid> grid_;
  nlohmann::ordered_json mission_, status_;  // as the page gets them
  TeamHistory history_;
  AgentHistory agents_;
  AmendmentHistory amendments_;
  Tick world_tick_ = -1;             // the newest
  std::int64_t used_revision_ = -1;  // of the roster, the newest that the world has used, …
  Tick used_since_ = 0;              // … from this tick on
  std::map<AgentId, Tick> recalled_from_;
  /// Each agent's newest commands by tick: those of a second of mission time, or the newest one.
  std::map<AgentId, std::map<Tick, Eigen::Vector3d>> commands_mps_;
  std::map<AgentId, LastLook> last_looks_;
  std::map<std::string, bool> trouble_;  // of the processes, by name
  std::deque<Incident> incidents_;
  std::map<std::string, double> outages_;  // that continue: their starts
  std::size_t changes_noted_ = 0;          // starts and ends of holds
  std::deque<std::string> lines_;
  std::uint64_t statuses_ = 0, incident_changes_ = 0, rosters_ = 0, line_count_ = 0;
  std::int64_t roster_revision_ = -1;
  std::string end_text_;
  std::vector<std::string> clients_;
};

}  // namespace ergocast
