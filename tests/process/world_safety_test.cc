// SPDX-License-Identifier: BSD-3-Clause
// Limits and emergency stops of vehicles, with the real programs.
#include <cmath>

#include "tests/process/support/bus_observer.h"
#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

constexpr Tick kHoldTicks = 40;  // 4.05 s of 0.1 s each; 0.8 s on the clock

/// A mission in real time whose agents a test silences.
class SilentAgent : public ByHand, public ::testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(Signals, SilentAgent, ::testing::Values(SIGSTOP, SIGKILL),
                         [](const auto& signal) {
                           return signal.param == SIGSTOP ? "Stopped" : "Killed";
                         });

TEST_P(SilentAgent, ItsVehicleStandsOnceItsLastCommandIsTooOld) {
  hand_all_but_agents(scenario(std::string("command_hold_s: 4.05 duration_s: ") + kEndless +
                               " pace: REALTIME realtime_factor: 5"));
  for (const char* id : {"0", "1", "2", "3"}) hand("ergocast-agent", {"--id", id});
  BusObserver observer(kUrl);
  ASSERT_TRUE(observer.observes([&] { return observer.answered(observer.member(1)) > 20; }));
  const Author silent = observer.member(1);
  signal_to(agent(1), GetParam());
  const Tick others = observer.answered(observer.member(0));
  ASSERT_TRUE(
      observer.observes([&] { return observer.answered(observer.member(0)) > others + 200; }));
  const Tick last = observer.answered(silent);
  ASSERT_TRUE(eventually([&] {
    const auto rows = recorded_rows(out());
    return !rows.empty() && rows.rbegin()->first > last + kHoldTicks + 100;
  }));
  const auto rows = recorded_rows(out());
  int stood = 0;
  const RecordedRow* rest = nullptr;
  for (const auto& [tick, agents] : rows) {
    if (tick <= last + kHoldTicks || !agents.contains(1)) continue;
    EXPECT_TRUE(agents.at(1).stands()) << tick;
    if (rest != nullptr) {
      EXPECT_EQ(agents.at(1).x_m, rest->x_m) << tick;
    }
    rest = &agents.at(1);
    ++stood;
  }
  EXPECT_GE(stood, 90);
  const auto held = rows.find(last + kHoldTicks);
  ASSERT_NE(held, rows.end());
  EXPECT_FALSE(held->second.at(1).stands()) << "it is held for that long";
}

class SpeedLimit : public RunningMission {
 protected:
  std::filesystem::path limited(const std::string& mps) {
    std::string text = text_of(scenario());
    text += "\nworld { speed_limit_mps: " + mps + " }\n";
    const auto file = folder_ / "quadrimodal_corners.textproto";
    std::ofstream(file) << text;
    return file;
  }
};

TEST_F(SpeedLimit, HoldsInTheRecordAndIsCountedAlikeOverLcmAndSimulated) {
  const auto file = limited("3");
  ASSERT_EQ(ergocast({"run", file, "--duration", "20", "--out", out()}), 0) << output();
  EXPECT_NE(output().find("limited to 3 m/s"), std::string::npos) << output();
  const auto flown = summary();
  int at_the_limit = 0;
  for (const auto& [tick, agents] : recorded_rows(out())) {
    for (const auto& [id, row] : agents) {
      const double speed = std::hypot(row.vx_mps, row.vy_mps);
      EXPECT_LE(speed, 3 * (1 + 1e-12)) << tick;
      at_the_limit += speed > 3 * (1 - 1e-12) ? 1 : 0;
    }
  }
  EXPECT_GT(at_the_limit, 0);
  EXPECT_EQ(flown["speed_limit"]["clamped_commands"], at_the_limit);
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  const auto trajectory = text_of(out() / "trajectory.csv");
  std::filesystem::remove_all(out());
  ASSERT_EQ(ergocast({"simulate", file, "--duration", "20", "--out", out()}), 0) << output();
  EXPECT_TRUE(text_of(out() / "trajectory.csv") == trajectory);
  EXPECT_EQ(summary()["speed_limit"], flown["speed_limit"]);
}

TEST_F(SpeedLimit, BelowWhatTheLawCommandsIsWarnedOf) {
  EXPECT_EQ(ergocast({"check", limited("3")}), 0);
  EXPECT_NE(output().find("warning: "), std::string::npos) << output();
  EXPECT_NE(output().find("world.speed_limit_mps: 3 cuts the method's noise short"),
            std::string::npos)
      << output();
  EXPECT_EQ(ergocast({"check", limited("1e6")}), 0);
  EXPECT_EQ(output().find("warning"), std::string::npos) << output();
}

}  // namespace
}  // namespace ergocast::test
