// SPDX-License-Identifier: BSD-3-Clause
// A team of two whose messages, tables and states a test gives to the invariants.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lab/invariants.h"
#include "tests/support/team.h"

namespace ergocast::test {

using lab::Invariants;
using lab::TableView;

/// The name of what was violated.
inline std::string violated_by(const Invariants& team) {
  return team.violation() ? std::string(name_of(team.violation()->invariant)) : "";
}

class InvariantsTest : public ::testing::Test {
 protected:
  InvariantsTest() : mission_(mission()), team_(mission_) {
    for (const Author& author : {kOne, kTwo, kLeft}) {
      team_.started(author);
      roster_.push_back({author, 0, author == kLeft ? 10 : -1});
    }
    team_.sent(0, world(99, {5, 5, 0}), nullptr);
  }

  static Mission mission() {
    Mission m;
    m.domain = {{0, 0, 0}, {10, 10, 0}};
    m.basis.modes_x = m.basis.modes_y = 12;
    m.target_coefficients = Coefficients::Zero(144);
    m.law.u_max_mps = 2;
    m.timing.dt_s = 0.1;
    m.timing.tick_count = 100;
    m.starts_m.resize(2);
    m.goal_ergodic_metric = 0.1;
    return m;
  }

  static Outgoing world(Tick tick, const Eigen::Vector3d& x_m) {
    WorldState state;
    state.header.tick = tick;
    state.vehicle_count = 1;
    state.vehicles[0].position_m = x_m;
    return {Bus::kWorld, state};
  }
  static Outgoing command(double speed_mps) {
    Command c;
    c.header.tick = 3;
    c.velocity_mps = {speed_mps, 0, 0};
    return {Bus::kCommand, c};
  }
  void cover(CoverageTable& table, const Author& author, int steps, double x_m = 3) {
    for (int i = 0; i < steps; ++i) {
      table.add_sample(author, BasisAt({x_m, 4, 0}, mission_.domain, mission_.basis));
    }
  }
  /// An agent that holds coverage of all agents.
  TableView holder(const CoverageTable& table, Coefficients& c, const Author& self = kOne) {
    c = Coefficients::Zero(144);
    table.average(c);
    TableView view{self, &table, &c, &roster_, 88};
    view.counted = 88;
    return view;
  }
  /// An agent that answers the tick of command().
  static TableView answering() {
    TableView view;
    view.self = kOne;
    view.answered = view.counted = 3;
    return view;
  }
  std::string violated() const { return violated_by(team_); }

  static constexpr Author kOne{0, 11}, kTwo{1, 22}, kLeft{1, 21};
  Mission mission_;
  Invariants team_;
  std::vector<RosterEntry> roster_;
  Coefficients c_one_, c_two_;
};

}  // namespace ergocast::test
