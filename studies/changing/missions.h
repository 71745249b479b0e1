// SPDX-License-Identifier: BSD-3-Clause
// The missions of this study: four peaks in a square of 2 km, which move while the team covers
// them.
#pragma once

#include <cstdint>
#include <numbers>
#include <string>

#include "core/mission/mission.h"

namespace ergocast::studies {

/// How far the four peaks are from the centre.
inline constexpr double kPeakRadius_m = 500 * std::numbers::sqrt2;

/// Where the four peaks are.
enum class Peaks {
  kCorners,    ///< on the diagonals
  kOneInside,  ///< one of them in the centre
  kTurned,     ///< all of them turned by 45° round the centre
};

/// What differs between missions.
struct MissionOptions {
  int agents = 4;
  double duration_s = 2000;
  std::string law{}, time{}, team{};  ///< more fields of these blocks of the scenario
};

/// A mission of the default law with random starts, which covers `peaks`.
Mission mission_of(const MissionOptions& options, Peaks peaks, std::uint64_t seed);

/// The target of peaks that are turned by so much from the corners.
Coefficients target_turned_by(double angle_rad);

}  // namespace ergocast::studies
