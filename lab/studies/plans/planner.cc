// SPDX-License-Identifier: BSD-3-Clause
// Takes the normalised steps of one plan, and pulls each node back into its two circles.
#include "lab/studies/plans/planner.h"

#include <algorithm>
#include <cmath>

#include "core/noise.h"

namespace ergocast::studies {
namespace {

/// Cuts `v` to `length`; whether it was longer.
template <class Vector>
bool cut(Vector&& v, double length) {
  const double is = v.norm();
  if (is <= length) return false;
  v *= length / is;
  return true;
}

}  // namespace

Planner::Planner(const Mission& mission, const PlanSetting& setting)
    : setting_(setting),
      u_max_mps_(mission.law.u_max_mps),
      domain_(mission.domain),
      seed_(mission.seed),
      cost_(mission, setting),
      nodes_(Nodes::Zero(3, setting.nodes)),
      announced_(nodes_),
      momentum_(nodes_),
      slope_(nodes_) {}

void Planner::draw(AgentId agent, const Eigen::Vector3d& along_mps) {
  for (Eigen::Index h = 0; h < nodes_.cols(); ++h) {
    // Nothing waits for answers here, so these numbers are free.
    const Eigen::Vector3d spread =
        normal_in(domain_, seed_, Purpose::kAnswer, static_cast<std::uint32_t>(agent),
                  static_cast<std::uint64_t>(h));
    nodes_.col(h) = along_mps + setting_.first_spread * u_max_mps_ * spread;
    cut(nodes_.col(h), u_max_mps_);
  }
}

void Planner::improve(const Outlook& outlook, const Eigen::Vector3d& x_m, bool trusted) {
  cost_(outlook, x_m, nodes_, slope_);
  // Nodes beyond the mission's end have no slope and no say.
  const auto flown = std::count_if(outlook.durations_s.begin(), outlook.durations_s.end(),
                                   [](double duration_s) { return duration_s > 0; });
  const double rms = std::sqrt(slope_.squaredNorm() / static_cast<double>(flown));
  if (!(rms > 0)) return;
  momentum_ = setting_.momentum * momentum_ + slope_ / rms;
  nodes_ -= setting_.step * u_max_mps_ * momentum_;
  for (Eigen::Index h = 0; h < nodes_.cols(); ++h) {
    cut(nodes_.col(h), u_max_mps_);
    if (!trusted) continue;
    // Between two velocities within u_max, so what is cut stays within it.
    Eigen::Vector3d away = nodes_.col(h) - announced_.col(h);
    if (!cut(away, setting_.trust * u_max_mps_)) continue;
    nodes_.col(h) = announced_.col(h) + away;
    momentum_.col(h) *= 0.5;
  }
}

void Planner::turn() {
  for (Nodes* nodes : {&nodes_, &announced_, &momentum_}) studies::turn(*nodes);
}

void Planner::mirror(int axis) {
  for (Nodes* nodes : {&nodes_, &announced_, &momentum_}) nodes->row(axis) *= -1;
}

}  // namespace ergocast::studies
