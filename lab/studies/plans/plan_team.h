// SPDX-License-Identifier: BSD-3-Clause
// A team whose agents each optimise a plan of their own against the announced plans of the others.
//
// It is flown like core/ideal_team.h: the same samples, vehicles, edges, starts, noise and pushes.
// An agent's command is the first node of its plan in the place of u of (8):
//   v = node_0 − k (x − centre) + perturbation
// where the perturbation answers to the coverage that the agent knows. Agents announce in the turns
// of next_broadcast(); a listener has an announcement one tick later, unless it is lost to it.
#pragma once

#include <memory>
#include <vector>

#include "core/control.h"
#include "lab/studies/plans/planner.h"

namespace ergocast::studies {

class PlanTeam {
 public:
  PlanTeam(Mission mission, const PlanSetting& setting);
  PlanTeam(const PlanTeam&) = delete;  // announcements refer to the mission
  PlanTeam& operator=(const PlanTeam&) = delete;

  void step();
  /// Steps through the whole mission.
  void fly();

  Tick tick() const { return tick_; }
  const Eigen::Vector3d& x_m(std::size_t agent) const { return agents_[agent].x_m; }
  const Planner& planner(std::size_t agent) const { return agents_[agent].planner; }
  /// φ² of all samples taken so far.
  double metric() const;

 private:
  struct Agent {
    Agent(AgentId number, const Eigen::Vector3d& start_m, const Mission& mission,
          const PlanSetting& setting);

    AgentId id;
    Eigen::Vector3d x_m, v_mps{0, 0, 0};
    BasisAt at;
    std::vector<double> sums_s;
    Planner planner;
    std::vector<std::shared_ptr<Announcement>> heard;  // by author; none: null
    bool news = true;  // whether others_s of later nodes has to be added up again
    Outlook outlook;
  };

  void sample(Agent& agent);
  void announce();
  void deliver();
  void look(Agent& agent);
  void command(Agent& agent);
  void move(Agent& agent);
  bool is_lost(AgentId author, AgentId listener) const;

  Mission mission_;
  PlanSetting setting_;
  PlanClock clock_;
  Controller controller_;
  Tick tick_ = 0, trusted_from_;
  std::vector<Agent> agents_;
  std::vector<std::shared_ptr<Announcement>> underway_;  // by author; null: nothing
  Coefficients coverage_;
};

}  // namespace ergocast::studies
