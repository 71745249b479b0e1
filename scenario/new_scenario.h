// SPDX-License-Identifier: BSD-3-Clause
// Writes a scenario for robots in the rooms of an occupancy map.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "scenario/parse/problem.h"

namespace ergocast {

/// The robots of a new scenario.
struct NewTeam {
  int robots = 4;
  double speed_mps = 0.5;  ///< the speed limit
  double radius_m = 0.2;
};

struct NewScenario {
  std::string text;               ///< with comments; load() finds no problem in it
  double free_m2 = 0;             ///< where the robots' centres can be
  std::vector<Problem> warnings;  ///< of load()
};

/// A scenario for the largest part of the map that the robots can reach. They start together in its
/// widest place. It steers by the modes of the free domain if cosines would be warned of.
/// @param map   a description, see target/maps/occupancy_map.h
/// @param file  the name that the text will have; the map's name is relative to its folder
Result<NewScenario, std::vector<Problem>> new_scenario(const std::filesystem::path& map,
                                                       const std::filesystem::path& file,
                                                       const NewTeam& team);

}  // namespace ergocast
