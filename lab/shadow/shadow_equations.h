// SPDX-License-Identifier: BSD-3-Clause
// The horizon, weights and gains of a forecast, computed a second time by the equations of
// core/law/look_ahead.h, and which batteries are charged. They share no code with core/.
#pragma once

#include <Eigen/Core>

#include "core/base/ids.h"
#include "core/basis/basis.h"
#include "core/mission/mission.h"
#include "team/messages.h"

namespace ergocast::lab {

/// h for a team of n: a s √(d/2) / (u_max n^(1/d)). If the plan asks for it, h is at most the time
/// left, and at most the mission's duration less the time for a way of length s.
double horizon_s(const Mission& mission, const Eigen::Matrix3d& covariance_m2, int n, Tick tick,
                 Tick tick_count);

/// w = h + min(span, cap) + age, or 0 for a teammate that has been silent for longer than h and the
/// cap.
double weight_s(const Mission& mission, double h_s, Tick span, Tick age, Tick period);

/// f(x) dt of every mode as the sensor of `kind` sees it: a Gaussian blurs each cosine by itself.
Coefficients seen_at(const Mission& mission, int kind, const Eigen::Vector3d& x_m);

/// Whether a vehicle's battery is charged, as a state of the world shows it: at most two steps,
/// with twice what the world and its errors may add, from its station, and slower than half its
/// speed.
bool is_charged(const Mission& mission, const Vehicle& vehicle);

}  // namespace ergocast::lab
