// SPDX-License-Identifier: BSD-3-Clause
// A mission that uses modes of the free domain: two rooms with a door between them.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace ergocast::test {

/// Writes the scenario into `folder`.
/// @param more         further fields, as text
/// @param more_agents  the number of further agents, which begin at random places
inline std::filesystem::path free_rooms(const std::filesystem::path& folder,
                                        const std::string& more = "", int more_agents = 0) {
  const auto file = folder / "rooms.textproto";
  std::ofstream(file) << R"(
      domain { size_x_m: 100 size_y_m: 50 }
      target { gaussians { mean_x_m: 80 mean_y_m: 20 sigma_m: 5 } }
      basis { modes_x: 5 modes_y: 4 free_domain: true }
      law { u_max_mps: 5 }
      time { dt_s: 0.1 duration_s: 10 pace: LOCKSTEP lockstep_timeout_s: 600 admission_timeout_s: 600 }
      agents { starts { x_m: 10 y_m: 20 } starts { x_m: 90 y_m: 30 } random_count: )"
                      << more_agents << R"( }
      world {
        speed_limit_mps: 20 wall_clearance_m: 1
        walls { vertices { x_m: 49.8 y_m: 10 } vertices { x_m: 50.2 y_m: 10 } vertices { x_m: 50.2 y_m: 60 } vertices { x_m: 49.8 y_m: 60 } }
      })" << more << '\n';
  return file;
}

}  // namespace ergocast::test
