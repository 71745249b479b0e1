// SPDX-License-Identifier: BSD-3-Clause
// What a team that announces plans is set to, and the stretches of time that its plans have in
// common.
#pragma once

#include <vector>

#include "core/mission.h"

namespace ergocast::studies {

struct PlanSetting {
  int nodes = 20;           ///< velocities of a plan
  double node_s = 5;        ///< how long one is held, a multiple of dt
  int points = 1;           ///< places a node at which f is taken
  double run_weight = 10;   ///< of φ² on the way, against φ² at the horizon
  double trust = 0.1;       ///< how far a node may go from its announced value [u_max]
  double trust_from = 0.5;  ///< when that begins to hold [longer side / u_max]
  double step = 0.03;       ///< of one improvement [u_max]
  double momentum = 0.9;
  double first_spread = 0.3;  ///< of the nodes of a first plan about −B [u_max]
  double announced_every_s = 2;
  double loss = 0;  ///< share of announcements that one listener does not get
};

/// Node h of every plan lasts from tick (⌊tick / D⌋ + h) D on for D = node_s / dt ticks: at any
/// tick the first node is partly flown, and all agents change nodes at the same ticks.
class PlanClock {
 public:
  /// Throws std::runtime_error if dt does not divide node_s.
  PlanClock(const Mission& mission, const PlanSetting& setting);

  /// Whether the first node of every plan is over at `tick`, and the next one begins.
  bool turns(Tick tick) const { return tick > 0 && tick % node_ticks_ == 0; }

  /// How long each node will still be flown [s], after the sample of `tick`. With ends_with_plan
  /// nothing is flown after the mission's last sample: nodes from there on have 0.
  void remaining_s(Tick tick, std::vector<double>& durations_s) const;

 private:
  double dt_s_;
  Tick node_ticks_, last_tick_;
};

}  // namespace ergocast::studies
