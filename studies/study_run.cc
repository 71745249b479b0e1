// SPDX-License-Identifier: BSD-3-Clause
// Runs the mission with an ideal team where that gives the same numbers, and with messages
// elsewhere.
#include "studies/study_run.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/law/block_layout.h"
#include "core/mission/kinds.h"
#include "core/mission/station.h"
#include "core/motion/filter_rules.h"
#include "core/motion/home.h"
#include "lab/ideal_team.h"
#include "lab/simulation.h"
#include "logger/null_buffer.h"
#include "logger/observer.h"
#include "plan/plan.h"
#include "studies/study_measure.h"
#include "team/state_assembler.h"

namespace ergocast::studies {
namespace {

using namespace std::string_literals;

/// The broadcasts of the whole team: each agent sends its coverage at its first tick, and in its
/// turns.
std::int64_t broadcasts_of(const Mission& mission, int block) {
  std::int64_t count = 0;
  for (AgentId id = 0; id < static_cast<AgentId>(mission.starts_m.size()); ++id) {
    for (Tick at = 0; at < mission.timing.tick_count; at = next_broadcast(mission, id, at, block))
      ++count;
  }
  return count;
}

std::int64_t blocks_sent(const Mission& mission) {
  std::int64_t count = 0;
  for (int b = 0; b < block_count_of(mission); ++b) count += broadcasts_of(mission, b);
  return count;
}

/// φ² as the logger computes it, by the same additions in the same order.
class Judge {
 public:
  /// @param judged  outlives it
  explicit Judge(const Mission& judged) : mission_(judged) { observer_.begin(judged); }

  void see(std::size_t agent, Tick tick, const Eigen::Vector3d& x_m) {
    observer_.see(mission_, tick, planned_kind(mission_, static_cast<AgentId>(agent)), x_m);
  }
  double metric() const { return observer_.metric(mission_); }

 private:
  const Mission& mission_;
  ergocast::Observer observer_;
};

/// Receives what the logger receives.
class Observer : public lab::SimulationObserver {
 public:
  explicit Observer(const Mission& mission)
      : mission_(mission),
        logger_(static_cast<lab::NodeId>(mission.starts_m.size()) + 2),
        measure_(mission),
        judge_(mission),
        vehicles_(mission.starts_m.size()) {}

  /// @pre no message has been received
  void follow(const lab::Simulation& simulation) { simulation_ = &simulation; }

  void received(lab::NodeId node, const Message& message) override {
    if (node != logger_) return;
    if (std::holds_alternative<Contribution>(message)) ++contributions_;
    if (const auto* world = std::get_if<WorldState>(&message)) receive(*world);
  }

  StudyFigures figures() const {
    StudyFigures figures = measure_.figures();
    figures.messages = contributions_;
    return figures;
  }

 private:
  void receive(const WorldState& world) {
    if (world.header.tick <= tick_) return;  // a repeat
    state_.take(world);
    if (!state_.complete(world.header.tick)) return;
    for (const WorldState& part : state_.states()) {
      for (const Vehicle& vehicle : part.vehicles_in_part()) {
        const auto agent = static_cast<std::size_t>(vehicle.id);
        if (agent < vehicles_.size()) vehicles_[agent] = vehicle;
      }
    }
    take(world.header.tick);
  }

  /// Takes in all of one tick, agent by agent.
  void take(Tick tick) {
    tick_ = tick;
    const Amendments& list = simulation_->coordinator().amendments();
    const bool ended = tick >= tick_count_of(mission_.timing, list.ends);
    for (std::size_t i = 0; i < vehicles_.size(); ++i) {
      if (tick > 0) measure_.command(vehicles_[i].velocity_mps);
      if (ended) continue;
      const Eigen::Vector3d& x_m = vehicles_[i].position_m;
      const auto id = static_cast<AgentId>(i);
      const bool covers = !rests(mission_, id, tick) &&
                          (tick == 0 || !charges(mission_, id, x_m, vehicles_[i].velocity_mps));
      measure_.position(i, tick, x_m, covers);
      if (covers) judge_.see(i, tick, x_m);
    }
    if (!ended) measure_.pass(tick);
    if (ended || !measure_.wants_metric(tick)) return;
    measure_.metric(tick, judge_.metric());
  }

  const Mission& mission_;
  const lab::Simulation* simulation_ = nullptr;
  const lab::NodeId logger_;
  StudyMeasure measure_;
  Judge judge_;
  StateAssembler state_;
  std::vector<Vehicle> vehicles_;  // at tick_
  Tick tick_ = -1;
  std::int64_t contributions_ = 0;
};

}  // namespace

StudyFigures run_without_messages(const Mission& mission, const LawMaker& laws) {
  const Mission judged = in_cosines(mission);
  StudyMeasure measure(judged);
  lab::IdealTeam team(mission, lab::Edges::kReflect, laws);
  Judge judge(judged);
  for (Tick tick = 0; tick < mission.timing.tick_count; ++tick) {
    for (std::size_t i = 0; i < team.size(); ++i) {
      measure.position(i, tick, team.x_m(i));
      judge.see(i, tick, team.x_m(i));
    }
    measure.pass(tick);
    team.step();
    for (std::size_t i = 0; i < team.size(); ++i) measure.command(team.v_mps(i));
    if (!measure.wants_metric(tick)) continue;
    measure.metric(tick, judge.metric());
  }
  StudyFigures figures = measure.figures();
  figures.messages = blocks_sent(mission);
  return figures;
}

StudyFigures run_with_messages(std::span<const std::byte> plan, const LawMaker& laws) {
  const Mission mission = decode_plan_with_table(plan).value();
  const Mission judged = in_cosines(mission);
  Observer observer(judged);
  NullBuffer nowhere;
  lab::SimulationOptions options{.plan = {plan.begin(), plan.end()}, .laws = laws};
  lab::Simulation simulation(std::move(options), nowhere, nowhere, &observer);
  observer.follow(simulation);
  simulation.run();
  return observer.figures();
}

StudyFigures run_study_mission(std::span<const std::byte> plan) {
  const Mission mission = decode_plan_with_table(plan).value();
  if (lab::IdealTeam::stands_for(mission)) return run_without_messages(mission);
  return run_with_messages(plan);
}

StudyFigures run_study_mission(std::span<const std::byte> plan, const LawMaker& laws) {
  const Mission mission = decode_plan_with_table(plan).value();
  if (lab::IdealTeam::stands_for(mission, laws(mission, 0)->needs()))
    return run_without_messages(mission, laws);
  return run_with_messages(plan, laws);
}

std::optional<std::string> why_not_in_python(const Mission& mission) {
  std::string fields = mission.radio_range_m > 0 ? "world.radio_range_m" : "";
  if (uses_beacons(mission)) fields += (fields.empty() ? "" : " and ") + "separation.lease_s"s;
  if (fields.empty()) return std::nullopt;
  return "a law in Python needs the places of all agents, and in " + mission.name +
         " no agent knows them (remove " + fields + ", or write the law in C++)";
}

}  // namespace ergocast::studies
