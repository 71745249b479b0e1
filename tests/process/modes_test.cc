// SPDX-License-Identifier: BSD-3-Clause
// The table of modes of a free domain: `ergocast run` hands it to its processes, those that were
// handed none compute it, the record has it, and who computes another stays out.
#include "tests/process/mission.h"

namespace ergocast::test {
namespace {

class TablesOfModes : public ByHand {
 protected:
  std::filesystem::path two_rooms() {
    const auto file = folder_ / "rooms.textproto";
    std::ofstream(file) << R"(
      domain { size_x_m: 100 size_y_m: 50 }
      target { gaussians { mean_x_m: 80 mean_y_m: 20 sigma_m: 5 } }
      basis { modes_x: 5 modes_y: 4 free_domain: true }
      law { u_max_mps: 5 }
      time { dt_s: 0.1 duration_s: 10 pace: LOCKSTEP lockstep_timeout_s: 600 admission_timeout_s: 600 }
      agents { starts { x_m: 10 y_m: 20 } starts { x_m: 90 y_m: 30 } }
      world {
        speed_limit_mps: 20 wall_clearance_m: 1
        walls { vertices { x_m: 49.8 y_m: 10 } vertices { x_m: 50.2 y_m: 10 } vertices { x_m: 50.2 y_m: 60 } vertices { x_m: 49.8 y_m: 60 } }
      })";
    return file;
  }
  /// The table in a folder, empty if there is none.
  static std::filesystem::path table_in(const std::filesystem::path& folder) {
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
      if (entry.path().filename().string().starts_with("modes-")) return entry.path();
    }
    return {};
  }
  /// The mission's table as another computer computes it, which rounds a number otherwise.
  std::filesystem::path table_of_another_computer() {
    EXPECT_EQ(ergocast({"simulate", two_rooms(), "--out", out()}), 0) << output();
    std::string bytes = text_of(table_in(out()));
    bytes[bytes.size() / 2 / 80 * 80] ^= 1;
    std::ofstream(folder_ / "other.bin", std::ios::binary) << bytes;
    return folder_ / "other.bin";
  }
  /// Whether that agent reads the table from its file, as one that computes it does not.
  bool shares_the_table(int id) const {
    const auto process = pids(agent(id));
    if (process.size() != 1) return false;
    const std::string maps = text_of("/proc/" + std::to_string(process[0]) + "/maps");
    return maps.find(table_in(out()).filename()) != std::string::npos;
  }
};

TEST_F(TablesOfModes, ALoggerThatWasStartedByHandWritesItBesideTheRecord) {
  std::filesystem::create_directory(out());
  Program& logger = hand("ergocast-logger", {"--out", out()});
  hand("ergocast-sim");
  for (const char* id : {"0", "1"}) hand("ergocast-agent", {"--id", id});
  Program& coordinator = hand("ergocast-coordinator", {two_rooms()});
  EXPECT_EQ(wait_for(coordinator.child), 0) << coordinator.said();
  EXPECT_EQ(wait_for(logger.child), 0) << logger.said();
  EXPECT_FALSE(table_in(out()).empty());
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

TEST_F(TablesOfModes, ARestartedAgentIsHandedItAgain) {
  Child mission = launch_endless(two_rooms());
  ASSERT_FALSE(table_in(out()).empty());
  EXPECT_TRUE(shares_the_table(1)) << said();
  kill_next(agent(1));
  ASSERT_TRUE(logs("agent-1", ": running", 2)) << said();
  EXPECT_TRUE(shares_the_table(1)) << said();
  ASSERT_TRUE(moves_on()) << said();
  mission.send(SIGTERM);
  EXPECT_EQ(wait_for(mission), 0) << said();
}

TEST_F(TablesOfModes, WhoComputesAnotherOneStaysOutAndSaysWhatToHandOver) {
  const auto other = table_of_another_computer();
  Program& equipped = hand("ergocast-agent", {"--id", "0", "--modes", other});
  Program& bare = hand("ergocast-agent", {"--id", "1"});
  hand("ergocast-coordinator", {two_rooms(), "--modes", other});
  EXPECT_EQ(wait_for(bare.child), 4) << bare.said();
  EXPECT_TRUE(bare.says("start it with --modes and that table's file, modes-")) << bare.said();
  EXPECT_TRUE(equipped.says("admitted")) << equipped.said();
  EXPECT_TRUE(equipped.child.running()) << equipped.said();
}

}  // namespace
}  // namespace ergocast::test
