// SPDX-License-Identifier: BSD-3-Clause
// The example driver in place of ergocast-sim; everything else is unchanged.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/process/bus_observer.h"
#include "tests/process/mission.h"
#include "tests/process/record.h"
#include "tests/process/stranger.h"

namespace ergocast::test {
namespace {

class DrivenRobots : public ByHand {
 protected:
  /// The default mission by the clock, ten times as fast.
  std::filesystem::path realtime_scenario(const std::string& duration_s) {
    return scenario("pace: REALTIME realtime_factor: 10 duration_s: " + duration_s);
  }
};

TEST_F(DrivenRobots, FlyAWholeMissionWhoseRecordIsComplete) {
  std::filesystem::create_directory(out());
  Program& logger = hand("ergocast-logger", {"--out", out()});
  Program& driver = hand("ergocast-example-driver");
  for (const char* id : {"0", "1", "2", "3"}) hand("ergocast-agent", {"--id", id});
  Program& coordinator = hand("ergocast-coordinator", {realtime_scenario("30")});
  EXPECT_EQ(wait_for(coordinator.child), 0) << coordinator.said();
  EXPECT_EQ(wait_for(driver.child), 0) << driver.said();
  EXPECT_EQ(wait_for(logger.child), 0) << logger.said();
  EXPECT_TRUE(driver.says("finished at tick 300: mission complete")) << driver.said();
  EXPECT_EQ(summary()["result"], "done");
  EXPECT_EQ(summary()["ticks"], 300);
}

TEST_F(DrivenRobots, StandStillAtOnceWhenTheyAreToldToStop) {
  std::filesystem::create_directory(out());
  Program& logger = hand("ergocast-logger", {"--out", out()});
  Program& driver = hand("ergocast-example-driver");
  for (const char* id : {"0", "1", "2", "3"}) hand("ergocast-agent", {"--id", id});
  hand("ergocast-coordinator", {realtime_scenario(kEndless)});
  ASSERT_TRUE(recorded(30000)) << driver.said();
  ASSERT_EQ(ergocast({"stop", "--now", "--lcm-url", kUrl}), 0) << output();
  EXPECT_EQ(wait_for(driver.child), 0) << driver.said();
  EXPECT_TRUE(driver.says("stopped at once")) << driver.said();
  EXPECT_EQ(wait_for(logger.child), 0) << logger.said();
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
  ASSERT_TRUE(recorded(30000)) << driver.said();
  Program& sim = hand("ergocast-sim");
  EXPECT_EQ(wait_for(sim.child), 4) << sim.said();
  EXPECT_TRUE(sim.says("a driver, or another world, moves its vehicles already")) << sim.said();
  EXPECT_EQ(sim.said().find("moving from tick"), std::string::npos) << "it has moved nothing";
  ASSERT_TRUE(moves_on()) << driver.said();
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  EXPECT_EQ(wait_for(driver.child), 0) << driver.said();
  EXPECT_EQ(wait_for(logger.child), 0) << logger.said();
}

TEST_F(DrivenRobots, RefuseAMissionInLockstep) {
  Program& driver = hand("ergocast-example-driver");
  for (const char* id : {"0", "1", "2", "3"}) hand("ergocast-agent", {"--id", id});
  Program& coordinator = hand("ergocast-coordinator", {scenario()});
  EXPECT_EQ(wait_for(driver.child), 4) << driver.said();
  EXPECT_TRUE(driver.says("give it pace: REALTIME")) << driver.said();
  EXPECT_TRUE(coordinator.says("running")) << coordinator.said();
}

/// Each robot has a driver of its own, which knows no other place.
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

TEST_F(RobotsWithTheirOwnDrivers, StandWhileOneIsNotHeardAndRefuseASecondDriver) {
  std::filesystem::create_directory(out());
  Program& logger = hand("ergocast-logger", {"--out", out()});
  std::vector<Program*> drivers;
  for (const char* id : {"0", "1", "2", "3"}) {
    drivers.push_back(&hand("ergocast-example-driver", {"--id", id}));
    hand("ergocast-agent", {"--id", id});
  }
  Program& coordinator = hand("ergocast-coordinator", {team_of_four()});
  ASSERT_TRUE(eventually_all({0, 1, 2, 3}, true)) << coordinator.said() << drivers[2]->said();

  Program& second = hand("ergocast-example-driver", {"--id", "2"});
  EXPECT_EQ(wait_for(second.child), 4) << second.said();
  EXPECT_TRUE(second.says("robot 2 is driven by another driver already")) << second.said();
  EXPECT_TRUE(drivers[2]->child.running()) << drivers[2]->said();

  drivers[2]->child.send(SIGKILL);
  EXPECT_TRUE(eventually_all({0, 1, 3}, false)) << "nobody echoes for robot 2: the lease is over";
  hand("ergocast-example-driver", {"--id", "2"});
  EXPECT_TRUE(eventually_all({0, 1, 2, 3}, true)) << "all are heard again";

  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  EXPECT_EQ(wait_for(logger.child), 0) << logger.said();
  // The rows of a tick are as far apart in time as the drivers' ticks.
  EXPECT_GE(least_distance_m(), kDistance_m - 2 * kStep_m);
}

// Somebody repeats what agent 1 has said, with another place, and echoes what nobody has sent.
TEST_F(RobotsWithTheirOwnDrivers, FlyOnBesideBeaconsOutOfOrderAndFromTheFuture) {
  std::filesystem::create_directory(out());
  hand("ergocast-logger", {"--out", out()});
  Program& first = hand("ergocast-agent", {"--id", "0"});
  for (const char* id : {"1", "2", "3"}) hand("ergocast-agent", {"--id", id});
  for (const char* id : {"0", "1", "2", "3"}) hand("ergocast-example-driver", {"--id", id});
  BusObserver observer(kUrl);
  Program& coordinator = hand("ergocast-coordinator", {team_of_four()});
  ASSERT_TRUE(eventually_all({0, 1, 2, 3}, true)) << coordinator.said();
  ASSERT_TRUE(observer.hears([&] { return observer.said(observer.member(1)) > 0; }));
  Beacon late;
  late.header = observer.block(observer.member(1)).header;
  late.position_m = {12, 12, 0};
  late.echo_count = 4;
  Stranger stranger(kUrl);
  EXPECT_TRUE(eventually([&] {
    stranger.say(Bus::kSwarm, late);
    return first.said().find("beacons of teammates overtake each other") != std::string::npos;
  })) << first.said();
  // It echoes what nobody has sent.
  Beacon early = late;
  early.roster_revision = std::int64_t{1} << 40;
  early.echoes.fill(40000);
  EXPECT_TRUE(eventually([&] {
    early.header.sequence += 3;  // soon newer than the newest of agent 1
    stranger.say(Bus::kSwarm, early);
    return first.said().find("answers to one that this agent has not sent yet") !=
           std::string::npos;
  })) << first.said();
  EXPECT_TRUE(eventually_all({0, 1, 2, 3}, true)) << first.said();
  EXPECT_GE(least_distance_m(), kDistance_m - 2 * kStep_m);
}

}  // namespace
}  // namespace ergocast::test
