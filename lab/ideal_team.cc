#include "lab/ideal_team.h"

#include <utility>

#include "core/geometry.h"

namespace ergocast::lab {

IdealTeam::IdealTeam(Mission mission, Edges edges)
    : mission_(std::move(mission)),
      edges_(edges),
      table_(mission_.basis, mission_.timing.dt_s),
      coverage_(Coefficients::Zero(mission_.basis.modes_x, mission_.basis.modes_y)),
      controller_(mission_) {
  for (const Eigen::Vector2d& start_m : mission_.starts_m) {
    const Author author{static_cast<AgentId>(agents_.size()), 1};
    table_.add_row(author);
    agents_.push_back(
        {author, start_m, {0, 0}, {0, 0}, BasisAt(start_m, mission_.domain, mission_.basis)});
  }
}

bool IdealTeam::stands_for(const Mission& mission) {
  const Timing& timing = mission.timing;
  return timing.pace == Pace::kLockstep && timing.broadcast_period_ticks == 1 &&
         timing.broadcast_error_budget == 0 && mission.radio_range_m == 0;
}

void IdealTeam::step() {
  for (Agent& agent : agents_) {
    agent.at = BasisAt(agent.x_m, mission_.domain, mission_.basis);
    table_.add_sample(agent.author, agent.at);
  }
  table_.average(coverage_);
  controller_.see(coverage_);
  for (Agent& agent : agents_) {
    agent.v_mps = within_speed_limit(
        mission_, controller_.command(agent.author.agent, tick_, agent.x_m, agent.at));
    agent.b = controller_.spectral_gradient();
  }
  for (Agent& agent : agents_) {
    agent.x_m = moved(mission_, agent.author.agent, tick_, agent.x_m, agent.v_mps);
    if (edges_ == Edges::kReflect) agent.x_m = reflect(agent.x_m, mission_.domain);
  }
  ++tick_;
}

void IdealTeam::run_until(double t_s, const std::function<void()>& each) {
  while (this->t_s() < t_s - 1e-9) {
    step();
    each();
  }
}

}  // namespace ergocast::lab
