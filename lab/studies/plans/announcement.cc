// SPDX-License-Identifier: BSD-3-Clause
// Rolls an announced plan along its own nodes; all but the first node's gain change only with a
// turn.
#include "lab/studies/plans/announcement.h"

#include <algorithm>
#include <utility>

namespace ergocast::studies {

Announcement::Announcement(const Mission& mission, const PlanSetting& setting, Tick tick,
                           std::vector<double> sums_s, const Eigen::Vector3d& x_m, Nodes nodes)
    : mission_(mission),
      clock_(mission, setting),
      points_(setting.points),
      tick_(tick),
      sums_s_(std::move(sums_s)),
      x_m_(x_m),
      nodes_(std::move(nodes)),
      durations_s_(static_cast<std::size_t>(setting.nodes)),
      gains_s_(static_cast<std::size_t>(setting.nodes) * sums_s_.size()) {
  clock_.remaining_s(tick_, durations_s_);
  foresee(0, setting.nodes);
}

void Announcement::advance(Tick tick) {
  if (tick == tick_) return;
  bool turned = false;
  while (tick_ < tick) {
    x_m_ += nodes_.col(0) * mission_.timing.dt_s;
    accumulate_basis(CosinesAt(x_m_, mission_.domain, mission_.basis), mission_.basis,
                     mission_.timing.dt_s, sums_s_.data());
    if (clock_.turns(++tick_)) {
      turn(nodes_);
      turned = true;
    }
  }
  clock_.remaining_s(tick_, durations_s_);
  foresee(0, turned ? static_cast<int>(nodes_.cols()) : 1);
}

void Announcement::foresee(int from, int to) {
  const std::size_t modes = sums_s_.size();
  Eigen::Vector3d at_m = x_m_;
  for (int node = from; node < to; ++node) {
    const auto n = static_cast<std::size_t>(node);
    double* gain = gains_s_.data() + n * modes;
    std::fill(gain, gain + modes, 0);
    if (durations_s_[n] <= 0) continue;
    add_gain(mission_, points_, at_m, nodes_.col(node), durations_s_[n], gain);
    at_m += durations_s_[n] * nodes_.col(node);
  }
}

void turn(Nodes& nodes) {
  for (Eigen::Index h = 0; h + 1 < nodes.cols(); ++h) nodes.col(h) = nodes.col(h + 1).eval();
  nodes.col(nodes.cols() - 1).setZero();
}

}  // namespace ergocast::studies
