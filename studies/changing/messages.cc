// SPDX-License-Identifier: BSD-3-Clause
// Peaks that jump once while the team exchanges messages: with and without dead reckoning, and with
// messages that are lost.
#include <cstdio>
#include <optional>
#include <string>
#include <variant>

#include "lab/simulation.h"
#include "logger/null_buffer.h"
#include "plan/plan.h"
#include "studies/changing/changing.h"
#include "studies/changing/judge.h"
#include "studies/changing/missions.h"
#include "team/state_assembler.h"

namespace ergocast::studies {
namespace {

constexpr Tick kAskedTick = 3000;  // after 300 s
struct Network {
  const char *name, *time, *team;
  double loss;
};
constexpr Network kNetworks[] = {
    {"lockstep", "", "", 0},
    {"lockstep without dead reckoning", "broadcast_period_ticks: 10", "dead_reckoning: false", 0},
    {"real time", "pace: REALTIME", "", 0},
    {"real time; 30 % lost", "pace: REALTIME", "", 0.3},
};

/// Judges the places that the logger receives from the tick on from which the new target holds.
class Witness : public lab::SimulationObserver {
 public:
  Witness(const Mission& mission, const Coefficients& target, std::string name, Results& results)
      : mission_(mission),
        target_(target),
        name_(std::move(name)),
        results_(results),
        logger_(static_cast<lab::NodeId>(mission.starts_m.size()) + 2),
        judge_(mission) {}

  void note_change(const Amendments& list) {
    if (!list.targets.empty()) from_ = list.targets.front().from;
  }
  bool done() const { return measured_ == kMeasured_s.size(); }

  void received(lab::NodeId node, const Message& message) override {
    const auto* const world = std::get_if<WorldState>(&message);
    if (node != logger_ || world == nullptr || done()) return;
    state_.take(*world);
    if (from_ && state_.newest() >= *from_ && state_.newest() > tick_) take();
  }
  void advanced(lab::NodeId, bool) override {}

 private:
  void take() {
    tick_ = state_.newest();
    const int at_s = kMeasured_s[measured_];
    if (tick_ >= *from_ + 10 * at_s) {
      results_.add({name_, measured_at(at_s)}, judge_.metric());
      ++measured_;
    }
    for (const Neighbour& vehicle : state_.neighbours(mission_))
      judge_.see(vehicle.position_m, target_);
  }

  const Mission& mission_;
  const Coefficients& target_;
  std::string name_;
  Results& results_;
  lab::NodeId logger_;
  Judge judge_;
  StateAssembler state_;
  std::optional<Tick> from_;
  Tick tick_ = -1;
  std::size_t measured_ = 0;
};

void run_network(const Network& network, std::uint64_t seed, Results& results) {
  const MissionOptions options{
      .agents = 4, .duration_s = 2000, .time = network.time, .team = network.team};
  const Mission mission = mission_of(options, Peaks::kCorners, seed);
  const Coefficients target = mission_of(options, Peaks::kOneInside, seed).target_coefficients;
  lab::Faults faults;
  faults.loss = network.loss;
  faults.swarm_bus_only = 1;
  faults.lasting_share = 1;
  Witness witness(mission, target, network.name, results);
  NullBuffer nowhere;
  lab::Simulation simulation({.plan = encode_plan(mission), .faults = faults}, nowhere, nowhere,
                             &witness);
  bool asked = false;
  while (!witness.done() && simulation.step()) {
    if (!asked && simulation.last_tick() >= kAskedTick) {
      simulation.change_target({.target = target, .cosine = {}});
      asked = true;
    }
    witness.note_change(simulation.coordinator().amendments());
  }
}

}  // namespace

void study_messages(int seeds, Results& results) {
  std::printf("| four agents |");
  for (const int at_s : kMeasured_s) std::printf(" φ² %s |", measured_at(at_s).c_str());
  std::printf(" after %d s against no loss |\n|---|---|---|---|---|\n", kMeasured_s.back());
  for (const Network& network : kNetworks) {
    for (int seed = 1; seed <= seeds; ++seed)
      run_network(network, static_cast<std::uint64_t>(seed), results);
    std::printf("| %s |", network.name);
    for (const int at_s : kMeasured_s)
      std::printf(" %s |", to_string(results.mean({network.name, measured_at(at_s)})).c_str());
    if (network.loss > 0) {
      const std::string at = measured_at(kMeasured_s.back());
      const Estimate ratio = results.ratio({network.name, at}, {kNetworks[2].name, at});
      std::printf(" %.2f (%.2f to %.2f) |\n", ratio.value, ratio.low, ratio.high);
    } else {
      std::printf(" – |\n");
    }
    std::fflush(stdout);
  }
}

}  // namespace ergocast::studies
