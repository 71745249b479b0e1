// SPDX-License-Identifier: BSD-3-Clause
// The example driver in place of ergocast-sim; everything else is unchanged.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/motion/starts.h"
#include "tests/process/support/bus_observer.h"
#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"
#include "tests/process/support/stranger.h"

namespace ergocast::test {
namespace {

class DrivenRobots : public ByHand {
 protected:
  /// The default mission by the clock, ten times as fast.
  std::filesystem::path realtime_scenario(const std::string& duration_s) {
    return scenario("pace: REALTIME realtime_factor: 10 duration_s: " + duration_s);
  }
};

TEST_F(DrivenRobots, RunAWholeMissionWhoseRecordIsComplete) {
  std::filesystem::create_directory(out());
  Program& logger = hand("ergocast-logger", {"--out", out()});
  Program& driver = hand("ergocast-example-driver");
  for (const char* id : {"0", "1", "2", "3"}) hand("ergocast-agent", {"--id", id});
  Program& coordinator = hand("ergocast-coordinator", {realtime_scenario("30")});
  EXPECT_EQ(wait_for(coordinator.child), 0) << coordinator.printed();
  EXPECT_EQ(wait_for(driver.child), 0) << driver.printed();
  EXPECT_EQ(wait_for(logger.child), 0) << logger.printed();
  EXPECT_TRUE(driver.prints("finished at tick 300: mission complete")) << driver.printed();
  EXPECT_EQ(summary()["result"], "done");
  EXPECT_EQ(summary()["ticks"], 300);
}

TEST_F(DrivenRobots, StandStillAtOnceAfterAStop) {
  std::filesystem::create_directory(out());
  Program& logger = hand("ergocast-logger", {"--out", out()});
  Program& driver = hand("ergocast-example-driver");
  for (const char* id : {"0", "1", "2", "3"}) hand("ergocast-agent", {"--id", id});
  hand("ergocast-coordinator", {realtime_scenario(kEndless)});
  ASSERT_TRUE(recorded(30000)) << driver.printed();
  ASSERT_EQ(ergocast({"stop", "--now", "--lcm-url", kUrl}), 0) << output();
  EXPECT_EQ(wait_for(driver.child), 0) << driver.printed();
  EXPECT_TRUE(driver.prints("stopped at once")) << driver.printed();
  EXPECT_EQ(wait_for(logger.child), 0) << logger.printed();
  const auto rows = recorded_rows(out());
  ASSERT_FALSE(rows.empty());
  for (const auto& [id, row] : rows.rbegin()->second) EXPECT_TRUE(row.stands()) << id;
}

TEST_F(DrivenRobots, RefuseASimulatedWorldBesideThem) {
  std::filesystem::create_directory(out());
  Program& logger = hand("ergocast-logger", {"--out", out()});
  Program& driver = hand("ergocast-example-driver");
  for (const char* id : {"0", "1", "2", "3"}) hand("ergocast-agent", {"--id", id});
  hand("ergocast-coordinator", {realtime_scenario(kEndless)});
  ASSERT_TRUE(recorded(30000)) << driver.printed();
  Program& sim = hand("ergocast-sim");
  EXPECT_EQ(wait_for(sim.child), 4) << sim.printed();
  EXPECT_TRUE(sim.prints("a driver, or another world, moves its vehicles already"))
      << sim.printed();
  EXPECT_EQ(sim.printed().find("moving from tick"), std::string::npos) << "it has moved nothing";
  ASSERT_TRUE(moves_on()) << driver.printed();
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  EXPECT_EQ(wait_for(driver.child), 0) << driver.printed();
  EXPECT_EQ(wait_for(logger.child), 0) << logger.printed();
}

TEST_F(DrivenRobots, RefuseAMissionInLockstep) {
  Program& driver = hand("ergocast-example-driver");
  for (const char* id : {"0", "1", "2", "3"}) hand("ergocast-agent", {"--id", id});
  Program& coordinator = hand("ergocast-coordinator", {scenario()});
  EXPECT_EQ(wait_for(driver.child), 4) << driver.printed();
  EXPECT_TRUE(driver.prints("give it pace: REALTIME")) << driver.printed();
  EXPECT_TRUE(coordinator.prints("running")) << coordinator.printed();
}

/// Each robot has its own driver, which knows only that robot's position.
class RobotsWithTheirOwnDrivers : public ByHand {
 protected:
  static constexpr double kDistance_m = 8, kStep_m = 1;

  std::filesystem::path team_of_four() {
    const auto file = folder_ / "four.textproto";
    std::ofstream(file) << R"(
      domain { size_x_m: 100 size_y_m: 100 }
      target { gaussians { mean_x_m: 50 mean_y_m: 50 sigma_m: 12 } }
      basis { modes_x: 8 modes_y: 8 }
      law { u_max_mps: 10 anticipation: 0 }
      time { dt_s: 0.1 duration_s: 1000000 pace: REALTIME command_hold_s: 0.1 admission_timeout_s: 600 }
      agents {
        starts { x_m: 10 y_m: 10 } starts { x_m: 90 y_m: 10 }
        starts { x_m: 10 y_m: 90 } starts { x_m: 90 y_m: 90 }
      }
      world { speed_limit_mps: 10 }
      separation { distance_m: 8 lease_s: 3 })";
    return file;
  }
  /// Waits until, in the newest 30 rows, each of these robots has moved, or none has.
  bool eventually_all(const std::vector<AgentId>& robots, bool move) {
    return eventually([&] {
      const auto rows = recorded_rows(out());
      return rows.size() >= 30 && std::ranges::all_of(robots, [&](AgentId id) {
               bool moved = false, heard = true;
               for (auto tick = std::prev(rows.end(), 30); tick != rows.end(); ++tick) {
                 const auto row = tick->second.find(id);
                 heard = heard && row != tick->second.end();
                 moved = moved || (heard && !row->second.stands());
               }
               return heard && moved == move;
             });
    });
  }
  double least_distance_m() {
    double least_m = std::numeric_limits<double>::max();
    for (const auto& [tick, rows] : recorded_rows(out())) {
      for (auto one = rows.begin(); one != rows.end(); ++one) {
        for (auto other = std::next(one); other != rows.end(); ++other) {
          least_m = std::min(least_m, std::hypot(one->second.x_m - other->second.x_m,
                                                 one->second.y_m - other->second.y_m));
        }
      }
    }
    return least_m;
  }
};

TEST_F(RobotsWithTheirOwnDrivers, StandWhileOneDriverIsSilentAndRefuseASecondDriver) {
  std::filesystem::create_directory(out());
  Program& logger = hand("ergocast-logger", {"--out", out()});
  std::vector<Program*> drivers;
  for (const char* id : {"0", "1", "2", "3"}) {
    drivers.push_back(&hand("ergocast-example-driver", {"--id", id}));
    hand("ergocast-agent", {"--id", id});
  }
  Program& coordinator = hand("ergocast-coordinator", {team_of_four()});
  ASSERT_TRUE(eventually_all({0, 1, 2, 3}, true)) << coordinator.printed() << drivers[2]->printed();

  Program& second = hand("ergocast-example-driver", {"--id", "2"});
  EXPECT_EQ(wait_for(second.child), 4) << second.printed();
  EXPECT_TRUE(second.prints("robot 2 is driven by another driver already")) << second.printed();
  EXPECT_TRUE(drivers[2]->child.running()) << drivers[2]->printed();

  drivers[2]->child.send(SIGKILL);
  EXPECT_TRUE(eventually_all({0, 1, 3}, false)) << "no beacon echoes robot 2: the lease is over";
  hand("ergocast-example-driver", {"--id", "2"});
  EXPECT_TRUE(eventually_all({0, 1, 2, 3}, true)) << "all are received again";

  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  EXPECT_EQ(wait_for(logger.child), 0) << logger.printed();
  // The rows of a tick are as far apart in time as the drivers' ticks.
  EXPECT_GE(least_distance_m(), kDistance_m - 2 * kStep_m);
}

// A foreign sender repeats agent 1's messages with another position, and echoes messages that no
// process has sent.
TEST_F(RobotsWithTheirOwnDrivers, GoOnBesideBeaconsOutOfOrderAndFromTheFuture) {
  std::filesystem::create_directory(out());
  hand("ergocast-logger", {"--out", out()});
  Program& first = hand("ergocast-agent", {"--id", "0"});
  for (const char* id : {"1", "2", "3"}) hand("ergocast-agent", {"--id", id});
  for (const char* id : {"0", "1", "2", "3"}) hand("ergocast-example-driver", {"--id", id});
  BusObserver observer(kUrl);
  Program& coordinator = hand("ergocast-coordinator", {team_of_four()});
  ASSERT_TRUE(eventually_all({0, 1, 2, 3}, true)) << coordinator.printed();
  ASSERT_TRUE(observer.observes([&] { return observer.steps_sent(observer.member(1)) > 0; }));
  Beacon late;
  late.header = observer.block(observer.member(1)).header;
  late.position_m = {12, 12, 0};
  late.echo_count = 4;
  Stranger stranger(kUrl);
  EXPECT_TRUE(eventually([&] {
    stranger.send(Bus::kSwarm, late);
    return first.printed().find("beacons of teammates arrive out of order") != std::string::npos;
  })) << first.printed();
  // It echoes a message that no process has sent.
  Beacon early = late;
  early.roster_revision = std::int64_t{1} << 40;
  early.echoes.fill(40000);
  EXPECT_TRUE(eventually([&] {
    early.header.sequence += 3;  // soon newer than the newest of agent 1
    stranger.send(Bus::kSwarm, early);
    return first.printed().find("answers one that this agent has not sent yet") !=
           std::string::npos;
  })) << first.printed();
  EXPECT_TRUE(eventually_all({0, 1, 2, 3}, true)) << first.printed();
  EXPECT_GE(least_distance_m(), kDistance_m - 2 * kStep_m);
}

}  // namespace
}  // namespace ergocast::test
