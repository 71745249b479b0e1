// SPDX-License-Identifier: BSD-3-Clause
// A folder with the tables that a killed recorder has left, for one that goes on with them.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "core/base/noise.h"
#include "logger/run_data.h"
#include "tests/logger/record.h"
#include "tests/support/temp_folder.h"

namespace ergocast::test {

/// Three agents that jump between positions, which use all digits of a double. Two come near each
/// other at tick 7.
inline WorldState team_at(Tick tick) {
  WorldState state = world_state(tick, {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  for (AgentId id = 0; id < 3; ++id) {
    Vehicle& vehicle = state.vehicles[static_cast<std::size_t>(id)];
    const auto step = static_cast<std::uint64_t>(tick);
    vehicle.position_m =
        on_ground(2000 * uniform_pair(1, Purpose::kStart, static_cast<std::uint32_t>(id), step));
    vehicle.velocity_mps =
        on_ground(normal_pair(2, Purpose::kStart, static_cast<std::uint32_t>(id), step));
  }
  if (tick == 7) {
    const Eigen::Vector3d& x_m = state.vehicles[0].position_m;
    state.vehicles[1].position_m = x_m + 1e-3 * (on_ground({1000, 1000}) - x_m);
  }
  return state;
}

class Resume : public testing::Test {
 protected:
  void write(const std::string& file, const std::string& text) const {
    std::ofstream(dir / file, std::ios::binary) << text;
  }
  std::string read(const std::string& file) const {
    std::ifstream in(dir / file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// The data that a resumed recorder finds after a killed one with these files.
  RunData past(const std::string& trajectory, const std::string& metrics) const {
    write("trajectory.csv", trajectory);
    write("metrics.csv", metrics);
    return read_run(dir, small_mission(1)).value();
  }
  /// The data after rows 0 … 9 of a single agent on its line.
  RunData ten_rows() const {
    Record former(small_mission(1));
    for (Tick tick = 0; tick <= 10; ++tick) former.deliver(state_of(tick));
    return past(former.trajectory.str(), former.metrics.str());
  }

  const TempFolder own;
  const std::filesystem::path& dir = own.path();
};

}  // namespace ergocast::test
