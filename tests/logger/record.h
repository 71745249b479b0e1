// SPDX-License-Identifier: BSD-3-Clause
// A recorder with its output streams, and the messages that tests send it.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "logger/recorder.h"
#include "tests/support/team.h"

namespace ergocast::test {

/// The whole lines of a table after its header.
inline std::vector<std::string> rows_of(const std::string& table) {
  std::istringstream lines(table.substr(0, table.rfind('\n') + 1));
  std::vector<std::string> rows;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) rows.push_back(line);
  return rows;
}

struct Record {
  /// @param past  what it resumes, if anything
  explicit Record(const Mission& mission, std::optional<RunData> past = {})
      : recorder(kRun, kLoggerLife, trajectory, metrics) {
    announce(mission);
    if (past) recorder.resume(std::move(*past));
    const auto team = static_cast<int>(mission.starts_m.size());
    give(recorder, mission_part(0, MissionState::kRunning, roster_of(team)), at(0s));
  }

  Outbox deliver(const Message& message, Instant now = at(0s)) {
    give(recorder, message, now);
    return advance(recorder, now);
  }

  std::vector<std::string> trajectory_rows() const { return rows_of(trajectory.str()); }
  std::vector<std::string> metrics_rows() const { return rows_of(metrics.str()); }

  std::ostringstream trajectory, metrics;
  Recorder recorder;
};

inline std::vector<std::string> columns(const std::string& row) {
  std::vector<std::string> found;
  std::istringstream fields(row);
  for (std::string field; std::getline(fields, field, ',');) found.push_back(field);
  return found;
}
inline double number(const std::string& row, std::size_t column) {
  return std::strtod(columns(row).at(column).c_str(), nullptr);
}

/// Agent 0 at `tick`, after a step with `applied_mps`.
inline WorldState state_of(Tick tick, const Eigen::Vector3d& x_m,
                           const Eigen::Vector3d& applied_mps) {
  WorldState state = world_state(tick, {x_m});
  state.vehicles[0].velocity_mps = applied_mps;
  return state;
}
/// Agent 0 on a straight line, a metre a tick.
inline WorldState state_of(Tick tick) {
  return state_of(tick, {100 + static_cast<double>(tick), 500, 0}, {10, 0, 0});
}

inline std::vector<Tick> acks(const Outbox& out) {
  std::vector<Tick> ticks;
  for (const Outgoing& outgoing : out) {
    if (const auto* ack = std::get_if<RecordAck>(&outgoing.message)) {
      EXPECT_EQ(outgoing.bus, Bus::kCommand);
      EXPECT_EQ(ack->header.sender, kLogger);
      EXPECT_EQ(ack->header.run, kRun);
      ticks.push_back(ack->header.tick);
    }
  }
  return ticks;
}

/// What the last acknowledgement in `out` says has been found; nothing: there is none.
inline std::optional<double> found(const Outbox& out) {
  std::optional<double> found;
  for (const Outgoing& outgoing : out)
    if (const auto* ack = std::get_if<RecordAck>(&outgoing.message))
      found = ack->detection_probability;
  return found;
}

inline Mission realtime_mission() {
  Mission mission = small_mission(1);
  mission.timing.pace = Pace::kRealtime;
  return mission;
}

}  // namespace ergocast::test
