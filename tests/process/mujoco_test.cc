// SPDX-License-Identifier: BSD-3-Clause
// Robots in a physics engine in place of ergocast-sim, in lockstep; everything else is unchanged.
#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

class RobotsInPhysics : public ByHand {
 protected:
  /// A short mission of four discs.
  std::filesystem::path four_discs() {
    std::string text =
        text_of(std::filesystem::path(ERGOCAST_SOURCE_DIR) / "examples/mujoco/discs.textproto");
    for (const auto& [from, to] : {std::pair{"random_count: 16", "random_count: 4"},
                                   std::pair{"duration_s: 60", "duration_s: 10"}})
      text.replace(text.find(from), std::string(from).size(), to);
    const auto file = folder_ / "discs.textproto";
    std::ofstream(file) << text;
    return file;
  }
};

TEST_F(RobotsInPhysics, RunAWholeMissionInLockstepWithoutContact) {
  std::filesystem::create_directory(out());
  Program& logger = hand("ergocast-logger", {"--out", out()});
  Program& world = hand("ergocast-example-mujoco");
  for (const char* id : {"0", "1", "2", "3"}) hand("ergocast-agent", {"--id", id});
  Program& coordinator = hand("ergocast-coordinator", {four_discs()});
  EXPECT_EQ(wait_for(coordinator.child), 0) << coordinator.printed();
  EXPECT_EQ(wait_for(world.child), 0) << world.printed();
  EXPECT_EQ(wait_for(logger.child), 0) << logger.printed();
  EXPECT_TRUE(world.prints("finished at tick 100: mission complete")) << world.printed();
  EXPECT_TRUE(world.prints("0 contacts of two robots, 0 of a robot and a wall")) << world.printed();
  EXPECT_EQ(summary()["result"], "done");
  EXPECT_EQ(summary()["ticks"], 100);
  EXPECT_GE(summary()["separation"]["nearest_m"], 0.45);
}

TEST_F(RobotsInPhysics, RefuseAMissionOfOtherVehicles) {
  Program& world = hand("ergocast-example-mujoco", {"--robots", "quadrotors"});
  for (const char* id : {"0", "1", "2", "3"}) hand("ergocast-agent", {"--id", id});
  std::string other = text_of(four_discs());
  other.erase(other.find("  response_s: 0.15"), 18);
  other += "vehicle { kind: UNICYCLE  max_turn_radps: 2 }\n";
  std::ofstream(folder_ / "other.textproto") << other;
  hand("ergocast-coordinator", {folder_ / "other.textproto"});
  EXPECT_EQ(wait_for(world.child), 4) << world.printed();
  EXPECT_TRUE(world.prints("vehicle { kind: POINT }")) << world.printed();
}

/// What docs/running.md shows: robots with real contacts in the office, held on the way.
class RobotsInTheOffice : public RunningMission {
 protected:
  /// φ² after 300 s; it starts at 0.78.
  static constexpr Tick kCoveredTick = 3000;
  static constexpr double kCovered = 0.02;

  std::string said_by_the_world() { return text_of(out() / "log/world.log"); }
  /// The newest tick in the complete rows of metrics.csv, which has one for each mission second; 0
  /// before.
  Tick measured_tick() {
    std::string rows = text_of(out() / "metrics.csv");
    rows.erase(rows.rfind('\n') + 1);
    if (rows.empty()) return 0;
    rows.pop_back();
    return std::strtoll(rows.c_str() + rows.rfind('\n') + 1, nullptr, 10);
  }
};

TEST_F(RobotsInTheOffice, ArePausedAndGoOnAndCoverItWithoutContact) {
  const auto office = std::filesystem::path(ERGOCAST_SOURCE_DIR) / "scenarios/office.textproto";
  Child mission = launch_endless(office, {"--lcm-url", kUrl, "--world", "ergocast-example-mujoco",
                                          "--world-arg=--robots", "--world-arg=discs"});
  ASSERT_EQ(ergocast({"pause", "--lcm-url", kUrl}), 0) << output();
  ASSERT_EQ(ergocast({"resume", "--lcm-url", kUrl}), 0) << output();
  ASSERT_TRUE(eventually([&] { return measured_tick() >= kCoveredTick; })) << printed();
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
  EXPECT_LT(summary()["ergodic_metric"]["last"], kCovered);
  EXPECT_NE(said_by_the_world().find("0 contacts of two robots, 0 of a robot and a wall"),
            std::string::npos)
      << said_by_the_world();
  EXPECT_EQ(summary()["holds"].size(), 1U);
  EXPECT_GE(summary()["separation"]["nearest_m"], 0.45);
  EXPECT_EQ(ergocast({"verify", out()}), 2);
  EXPECT_NE(output().find("another program than ergocast-sim"), std::string::npos) << output();
}

TEST_F(RobotsInTheOffice, TheWorldTakesTheLagFromWorldArg) {
  EXPECT_EQ(ergocast({"run", "office", "--world", "ergocast-example-mujoco", "--world-arg=--lag",
                      "--world-arg=9", "--out", out()}),
            4);
  EXPECT_NE(said_by_the_world().find("--lag"), std::string::npos) << said_by_the_world();
  EXPECT_EQ(ergocast({"run", "office", "--world-arg=--lag"}), 2) << "without --world";
}

/// Two rooms with a door of 1.6 m, as a robot's map.
class RobotsInARobotsMap : public OwnHost {
 protected:
  std::filesystem::path map() const {
    std::ofstream picture(folder_ / "floor.pgm");
    picture << "P2 50 30 255\n";
    for (int row = 0; row < 30; ++row) {
      for (int column = 0; column < 50; ++column) {
        const bool side = row == 0 || row == 29 || column == 0 || column == 49;
        const bool between = column == 24 && (row < 11 || row > 18);
        picture << (side || between ? "0 " : "254 ");
      }
    }
    std::ofstream(folder_ / "floor.yaml")
        << "image: floor.pgm\nresolution: 0.2\norigin: [0, 0, 0]\nnegate: 0\n"
           "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
    return folder_ / "floor.yaml";
  }
};

TEST_F(RobotsInARobotsMap, CoverItWithoutContact) {
  const std::filesystem::path scenario = folder_ / "floor.textproto";
  ASSERT_EQ(ergocast({"new", "--map", map(), "--out", scenario}), 0) << output();
  ASSERT_EQ(ergocast({"run", scenario, "--set", "separation.response_s=0.15", "--duration", "60",
                      "--lockstep", "--world", "ergocast-example-mujoco", "--out", out()}),
            0)
      << output();
  const std::string world = text_of(out() / "log/world.log");
  EXPECT_NE(world.find("0 contacts of two robots, 0 of a robot and a wall"), std::string::npos)
      << world;
  EXPECT_LT(summary()["ergodic_metric"]["last"], 0.1);
}

}  // namespace
}  // namespace ergocast::test
