// SPDX-License-Identifier: BSD-3-Clause
// The run record: trajectory.csv and metrics.csv from the world's states, as an outside observer.
//
// If each robot has a driver of its own, each driver sends one part of a state, and the recorder
// joins the parts. The rows of a part that does not arrive in time are missing.
//
// Tick n's row needs two states. State n has the position, and state n+1 has the velocity that the
// world applied in between. Rows are written in order and acknowledged to the world, which in
// lockstep repeats every missing state. Acknowledged rows are in the file, so a killed recorder
// receives all lost rows again. While its streams are bad, as on a full disk, no row is written and
// none acknowledged.
//
// In lockstep the row of a tick is written once the revision of MISSION is known that the world
// names for it. So it counts against the target that the agents of this tick have.
//
// In lockstep a row is missing only if no process can repeat its states. Such states precede the
// first one that a resumed recorder received, or the first one of a restarted world. Others are
// those of a time in which the recorder could not write, or in which the world had given up a
// disconnected recorder.
#pragma once

#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "logger/agent_reports.h"
#include "logger/received_amendments.h"
#include "logger/record_tables.h"
#include "logger/run_data.h"
#include "logger/waiting_states.h"
#include "team/messages.h"
#include "team/participant.h"

namespace ergocast {

class Recorder {
 public:
  static constexpr Role kRole = Role::kLogger;

  /// Writes to streams that outlive it; the caller repairs bad streams and calls go_on().
  /// @param run  the run to record; 0: the run of the first mission received
  /// @pre both streams are good: a stream that is bad from the beginning would never be written. To
  /// discard the tables, pass a NullBuffer (logger/null_buffer.h).
  Recorder(RunId run, Incarnation incarnation, std::ostream& trajectory, std::ostream& metrics);

  /// Continues the record of a former process with all its segments; the record may be empty. Its
  /// rows are added to the observer's sums again in their order, with the present roster. So φ²
  /// continues bit for bit. Metrics rows that are due and missing are written.
  /// @param plan  the record's: any other mission received is a plan_problem(); empty: any is
  /// accepted
  /// @pre nothing has been received
  void resume(RunData past, std::vector<std::byte> plan = {});

  /// The streams are good again: their buffered data is written. A world that has given this
  /// recorder up accepts it again under its new incarnation.
  void go_on(Instant now);

  void receive(const Message& message, Bus bus, AgentId transmitter, Instant now);
  void advance(Instant now, Outbox& out);
  /// Ends the record with the rows so far.
  void stop(std::string reason);
  Instant next_wakeup() const;

  /// True once the last tick is recorded or the mission is over, and nothing more can arrive.
  /// Nothing can arrive once world and agents have reported that they leave, or 1 s has passed.
  bool finished() const { return ending_.finished; }
  RunId run() const { return me_.run(); }
  const MissionFollower& follower() const { return me_.follower(); }
  /// "done" (its last tick is recorded), "failed" (also if φ² is not a number) or "stopped" (an
  /// operator ended it); reason() has the cause.
  const char* result() const;
  const std::string& reason() const { return ending_.reason; }
  const RunFacts& facts() const { return tables_.facts(); }
  /// What the team has achieved so far, once the mission is known; costs a pass over all cells.
  std::optional<TeamFigures> team_figures() const {
    return tables_.begun() ? std::optional(tables_.team_figures()) : std::nullopt;
  }
  /// With false alarms: Confirmations::contacts(), with their times.
  std::vector<Contact> contacts() const;
  /// All amendments of the mission that this recorder or a former one has received.
  const ReceivedAmendments& amendments() const { return amendments_; }
  /// The newest status of each incarnation that Liveness holds, with the worst loop lag of all its
  /// statuses.
  const std::map<Author, AgentStatus>& statuses() const { return reports_.statuses(); }
  Blocks blocks() const { return reports_.blocks(follower()); }
  Tick next_row() const { return row_.tick; }
  /// The newest tick with a received state.
  Tick newest() const { return received_.newest; }

 private:
  /// The messages received of the world.
  struct Received {
    Incarnation world = 0;    // the last one received
    Tick newest = 0;          // of the states received
    Tick lost_before = 0;     // states of earlier ticks may be gone for good
    bool world_left = false;  // its last message was received
    bool drivers = false;     // each robot has a driver of its own
  };
  struct Ending {
    std::optional<Instant> since;  // from then on nothing more is expected
    bool finished = false, failed = false;
    std::string reason;
  };
  template <class M>
  void on(const M&, const Arrival&) {}  // the other types need no action
  void on(const WorldState& world, const Arrival& arrival);
  void on(const AgentStatus& status, const Arrival& arrival);
  void on(const MissionPart& part, const Arrival& arrival);
  void on(const Stop& stop, const Arrival& arrival);
  const Mission& mission() const { return me_.mission(); }
  void meet(const Header& world, Instant now);
  void begin();
  void write_rows(Instant now);
  void acknowledge(Instant now, Outbox& out);
  bool contacts_are_old() const;
  RecordAck record_ack(bool last);
  bool write_next_row(Instant now);
  bool awaits_mission(const TickState& state, Instant now);
  MissionKnowledge known() const { return {follower(), reports_, amendments_}; }
  bool holds(Tick tick) const;
  bool has_drivers() const;
  std::int64_t missing_positions(const TickState& state, const TickState& next) const;
  bool is_of_a_driver(const WorldState& part) const;
  bool all_rows_written() const {
    return me_.knows_mission() && row_.counted() >= me_.tick_count();
  }
  bool gap_ahead() const;
  bool gap_is_final(Instant now) const;
  bool given_up(Instant now) const;
  void skip_gap();
  void fail(std::string reason);
  bool abandoned(Instant now) const;
  bool everybody_left(Instant now) const;
  void close();
  bool is_lockstep() const;

  Participant me_;
  RecordTables tables_;
  AgentReports reports_;
  ReceivedAmendments amendments_;
  WaitingStates states_;
  RowTick row_;                                  // the next one
  Instant progress_{};                           // last row, or first message of a new world
  std::optional<Instant> awaits_mission_since_;  // the revision of the next row's state
  Received received_;
  Tick acked_ = -2;
  Instant next_ack_{};
  Ending ending_;
  std::optional<RunData> former_rows_;  // of a former process, until the mission is known
  bool resumed_ = false;                // whether there was one
  std::vector<Contact> contacts_;       // with false alarms, as RECORD_ACK lists them, …
  std::optional<Tick> contacts_at_;     // … by what was recorded before that row
};

}  // namespace ergocast
