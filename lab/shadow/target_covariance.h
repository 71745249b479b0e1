// SPDX-License-Identifier: BSD-3-Clause
// The covariance of a mission's target: the laboratory's own computation of what
// core/law/look_ahead.h computes.
#pragma once

#include <Eigen/Core>

#include "core/mission/mission.h"

namespace ergocast::lab {

/// That of the plan's target, along the axes of the domain; 0 along z in a plane.
Eigen::Matrix3d target_covariance_m2(const Mission& mission);

}  // namespace ergocast::lab
