// SPDX-License-Identifier: BSD-3-Clause
// Shipped missions, and teams that run them in one process: ideal teams, simulated teams, and teams
// under faults.
#pragma once

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lab/ideal_team.h"
#include "lab/simulation.h"
#include "lab/trial.h"
#include "plan/plan.h"
#include "scenario/scenario.h"

namespace ergocast::test {

// ---- missions ----

/// A shipped scenario; fails loudly if the file has problems.
inline Scenario shipped_scenario(const std::string& name, const Overrides& overrides = {}) {
  const auto file = std::filesystem::path(ERGOCAST_SCENARIO_DIR) / (name + ".textproto");
  return Scenario::load(file, overrides).value();
}
inline Mission shipped_mission(const std::string& name, const Overrides& overrides = {}) {
  return shipped_scenario(name, overrides).mission();
}

/// `text` with another part in the place of its first `from`, which must be there.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  return at == text.npos ? throw std::logic_error(from) : text.replace(at, from.size(), to);
}

// ---- teams ----

using PaperTeam = lab::IdealTeam;
using Drop = std::function<bool(const Message&, lab::NodeId to)>;

/// A simulation without faults, and what its recorder has written.
struct SimulatedTeam {
  explicit SimulatedTeam(const Mission& mission, Drop drop = {}, Amendments amendments = {})
      : simulation({.plan = encode_plan(mission),
                    .amendments = std::move(amendments),
                    .drop = std::move(drop)},
                   trajectory, metrics) {}

  /// Runs until all is over, or `limit` of virtual time has passed. Returns whether all was over
  /// before.
  bool run(std::chrono::nanoseconds limit = std::chrono::hours(1000)) {
    simulation.run(limit);
    return simulation.now().time_since_epoch() < limit;
  }
  MissionState state() const { return simulation.coordinator().state(); }
  const std::string& reason() const { return simulation.coordinator().reason(); }

  std::ostringstream trajectory, metrics;
  lab::Simulation simulation;
};

/// A trial, and what its recorder has written.
struct TriedTeam {
  TriedTeam(const lab::Faults& faults, std::uint64_t seed, const Scenario& scenario,
            const SubscriptionTable& subscriptions = kSubscriptions) {
    std::ostringstream rows, metrics;
    result = lab::run_trial({.plan = encode_plan(scenario.with_seed(seed).mission()),
                             .faults = faults,
                             .version = "test",
                             .subscriptions = subscriptions},
                            rows, metrics);
    trajectory = rows.str();
  }
  /// The violation; empty if there is none.
  std::string problem() const { return result.violation ? to_string(*result.violation) : ""; }

  lab::TrialResult result;
  std::string trajectory;
};

// ---- figures ----

/// The probability that a test fails with other seeds although its statement is true.
inline constexpr double kError = 1e-9;

inline double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace ergocast::test
