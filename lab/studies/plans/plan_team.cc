// SPDX-License-Identifier: BSD-3-Clause
// Samples, delivers, announces, plans and moves, in this order, each tick.
#include "lab/studies/plans/plan_team.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/geometry.h"
#include "core/noise.h"
#include "core/vectorized.h"
#include "core/vehicle.h"

namespace ergocast::studies {
namespace {

/// The announcements of the mission are made in the turns of its broadcasts.
Mission with_period(Mission mission, double period_s) {
  mission.timing.broadcast_period_ticks =
      static_cast<int>(std::max(1L, std::lround(period_s / mission.timing.dt_s)));
  return mission;
}

ERGOCAST_VECTORIZED
void add(const double* from, std::size_t count, double* to) {
  for (std::size_t k = 0; k < count; ++k) to[k] += from[k];
}

}  // namespace

PlanTeam::Agent::Agent(AgentId number, const Eigen::Vector3d& start_m, const Mission& mission,
                       const PlanSetting& setting)
    : id(number),
      x_m(start_m),
      at(start_m, mission.domain, mission.basis),
      sums_s(static_cast<std::size_t>(mission.basis.mode_count())),
      planner(mission, setting),
      heard(mission.starts_m.size()) {
  outlook.durations_s.resize(static_cast<std::size_t>(setting.nodes));
  outlook.known_s = sums_s;
  outlook.others_s.resize(static_cast<std::size_t>(setting.nodes) * sums_s.size());
}

PlanTeam::PlanTeam(Mission mission, const PlanSetting& setting)
    : mission_(with_period(std::move(mission), setting.announced_every_s)),
      setting_(setting),
      clock_(mission_, setting),
      controller_(mission_),
      trusted_from_(
          static_cast<Tick>(std::ceil(setting.trust_from * mission_.domain.size_m.maxCoeff() /
                                      mission_.law.u_max_mps / mission_.timing.dt_s))),
      underway_(mission_.starts_m.size()),
      coverage_(Coefficients::Zero(mission_.basis.mode_count())) {
  for (const Eigen::Vector3d& start_m : mission_.starts_m)
    agents_.emplace_back(static_cast<AgentId>(agents_.size()), start_m, mission_, setting_);
}

void PlanTeam::step() {
  for (Agent& agent : agents_) sample(agent);
  deliver();
  if (tick_ > 0) announce();
  for (Agent& agent : agents_) {
    look(agent);
    command(agent);
  }
  for (Agent& agent : agents_) move(agent);
  ++tick_;
}

void PlanTeam::fly() {
  while (tick_ < mission_.timing.tick_count) step();
}

void PlanTeam::sample(Agent& agent) {
  agent.at = BasisAt(agent.x_m, mission_.domain, mission_.basis);
  accumulate_basis(agent.at, mission_.basis, mission_.timing.dt_s, agent.sums_s.data());
  if (!clock_.turns(tick_)) return;
  agent.planner.turn();
  agent.news = true;
}

/// What was announced in the last tick.
void PlanTeam::deliver() {
  for (std::size_t author = 0; author < agents_.size(); ++author) {
    const std::shared_ptr<Announcement> sent = std::exchange(underway_[author], nullptr);
    if (sent == nullptr) continue;
    for (Agent& listener : agents_) {
      const auto id = static_cast<AgentId>(author);
      if (listener.id == id || is_lost(id, listener.id)) continue;
      listener.heard[author] = sent;
      listener.news = true;
    }
  }
}

bool PlanTeam::is_lost(AgentId author, AgentId listener) const {
  const auto who = static_cast<std::uint32_t>(author * kMaxAgents + listener);
  return uniform_pair(mission_.seed, Purpose::kFault, who, static_cast<std::uint64_t>(tick_)).x() <
         setting_.loss;
}

/// All at the first tick that has plans, then in turns.
void PlanTeam::announce() {
  for (Agent& agent : agents_) {
    if (tick_ > 1 && next_broadcast(mission_, agent.id, tick_ - 1) != tick_) continue;
    agent.planner.announce();
    underway_[static_cast<std::size_t>(agent.id)] = std::make_shared<Announcement>(
        mission_, setting_, tick_, agent.sums_s, agent.x_m, agent.planner.nodes());
  }
}

/// Adds up what the agent has heard, continued to this tick.
void PlanTeam::look(Agent& agent) {
  const std::size_t modes = agent.sums_s.size();
  Outlook& outlook = agent.outlook;
  clock_.remaining_s(tick_, outlook.durations_s);
  outlook.known_agents = 1;
  outlook.known_s = agent.sums_s;
  const std::size_t changed = agent.news ? outlook.others_s.size() : modes;
  std::fill_n(outlook.others_s.begin(), changed, 0);
  for (const auto& teammate : agent.heard) {
    if (teammate == nullptr) continue;
    teammate->advance(tick_);
    ++outlook.known_agents;
    add(teammate->sums_s().data(), modes, outlook.known_s.data());
    add(teammate->gains_s().data(), changed, outlook.others_s.data());
  }
  outlook.covered_s =
      static_cast<double>((tick_ + 1) * outlook.known_agents) * mission_.timing.dt_s;
  agent.news = false;
}

/// The law's own command, with the first node in the place of its u.
void PlanTeam::command(Agent& agent) {
  for (Eigen::Index k = 0; k < coverage_.size(); ++k) {
    coverage_.data()[k] =
        agent.outlook.known_s[static_cast<std::size_t>(k)] / agent.outlook.covered_s;
  }
  controller_.set_coverage(coverage_);
  const Eigen::Vector3d law_mps = controller_.command(agent.id, tick_, agent.x_m, agent.at);
  const Eigen::Vector3d u_mps =
      smooth_input(controller_.spectral_gradient(), controller_.epsilon(), mission_.law.u_max_mps);
  if (tick_ == 0) agent.planner.draw(agent.id, u_mps);
  if (agent.outlook.durations_s.front() > 0) {
    agent.planner.improve(agent.outlook, agent.x_m, tick_ > 1 && tick_ >= trusted_from_);
  }
  agent.v_mps = within_speed_limit(motion_of(mission_, agent.id),
                                   law_mps - u_mps + agent.planner.nodes().col(0));
}

void PlanTeam::move(Agent& agent) {
  const Box& domain = mission_.domain;
  const Eigen::Vector3d straight_m = moved(mission_, agent.id, tick_, agent.x_m, agent.v_mps);
  agent.x_m = reflect(straight_m, domain);
  for (int axis = 0; axis < 2; ++axis) {
    const double folds =
        std::floor((straight_m(axis) - domain.origin_m(axis)) / domain.size_m(axis));
    if (agent.x_m(axis) != straight_m(axis) && std::fmod(folds, 2) != 0) agent.planner.mirror(axis);
  }
}

double PlanTeam::metric() const {
  Coefficients coverage = Coefficients::Zero(mission_.basis.mode_count());
  for (const Agent& agent : agents_) {
    for (Eigen::Index k = 0; k < coverage.size(); ++k)
      coverage.data()[k] += agent.sums_s[static_cast<std::size_t>(k)];
  }
  coverage /= static_cast<double>(tick_ * static_cast<Tick>(agents_.size())) * mission_.timing.dt_s;
  return controller_.metric(coverage);
}

}  // namespace ergocast::studies
