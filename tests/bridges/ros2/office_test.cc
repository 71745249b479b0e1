// SPDX-License-Identifier: BSD-3-Clause
// Differential-drive robots in MuJoCo behind cmd_vel and odom cover the scenario `office`: real
// agents over LCM, the real bridge, and the robots' topics over CycloneDDS.
#include <fstream>

#include "tests/bridges/order_socket.h"
#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

using nlohmann::json;

class RosRobotsInPhysics : public ByHand {
 protected:
  static constexpr int kRobots = 6, kPort = 14570;
  /// φ² at the start is 0.78, with all robots in the corridor.
  static constexpr double kCovered = 0.35;

  /// The shipped scenario, for robots that follow late, in real time and without an end.
  std::filesystem::path office() const {
    const std::string folder = ERGOCAST_SOURCE_DIR "/scenarios/";
    std::string text = text_of(folder + "office.textproto");
    const auto replace = [&](const std::string& from, const std::string& to) {
      const auto at = text.find(from);
      ASSERT_NE(at, text.npos) << from;
      text.replace(at, from.size(), to);
    };
    replace("maps/office.svg", folder + "maps/office.svg");
    replace("speed_limit_mps: 1", "speed_limit_mps: 0.5");
    replace("distance_m: 0.45  response_s: 0.15",
            "distance_m: 0.6  lease_s: 3  response_s: 0.4  position_error_m: 0.02");
    replace("u_max_mps: 0.8", "u_max_mps: 0.5  anticipation: 0  perturbation: CONSTANT");
    replace("duration_s: 1200",
            "duration_s: 1000000  dt_s: 0.1  pace: REALTIME  command_hold_s: 0.2  "
            "admission_timeout_s: 600");
    const auto file = folder_ / "office.textproto";
    std::ofstream(file) << text;
    return file;
  }
  std::filesystem::path bridge_file() const {
    const auto file = folder_ / "bridge.textproto";
    std::ofstream out(file);
    out << "frames { name: \"map\" }\n";
    for (int id = 0; id < kRobots; ++id) {
      const std::string name = "robot" + std::to_string(id);
      out << "robots { id: " << id << " drive: DIFFERENTIAL cmd_vel: \"" << name
          << "/cmd_vel\" odom: \"" << name << "/odom\" frame: \"map\" base_frame: \"" << name
          << "/base_link\" max_speed_mps: 0.5 max_turn_radps: 3 }\n";
    }
    return file;
  }
  /// The modes of the office, which the agents then need not compute.
  std::filesystem::path modes(const std::filesystem::path& scenario) {
    const auto record = folder_ / "modes";
    EXPECT_EQ(ergocast({"simulate", scenario, "--lockstep", "--duration", "0.1", "--out", record}),
              0)
        << output();
    for (const auto& entry : std::filesystem::directory_iterator(record))
      if (entry.path().filename().string().starts_with("modes-")) return entry.path();
    ADD_FAILURE() << "no table of modes";
    return {};
  }
  /// φ² in the last complete row of metrics.csv; 1 before the first one.
  double metric() const {
    std::string rows = text_of(out() / "metrics.csv");
    rows.erase(rows.rfind('\n') + 1);
    const auto head = rows.find('\n');
    if (head == rows.npos || head + 1 == rows.size()) return 1;
    rows.pop_back();
    const char* row = rows.c_str() + rows.rfind('\n') + 1;
    double tick = 0, t_s = 0, metric = 1;
    return std::sscanf(row, "%lf,%lf,%lf", &tick, &t_s, &metric) == 3 ? metric : 1;
  }
};

TEST_F(RosRobotsInPhysics, CoverTheOfficeWithoutContact) {
  const auto scenario = office();
  const std::string table = modes(scenario);
  std::filesystem::create_directory(out());
  Child robots = begin({ERGOCAST_BIN_DIR "/mujoco-robots", std::to_string(kPort), scenario});
  const OrderSocket room(kPort);
  Program& logger = hand("ergocast-logger", {"--out", out(), "--modes", table});
  Program& driver = hand("ergocast-ros2", {bridge_file(), "--modes", table});
  for (int id = 0; id < kRobots; ++id) {
    const std::string robot = "robot " + std::to_string(id);
    EXPECT_TRUE(driver.prints(robot + ": waits for the mission")) << driver.printed();
    hand("ergocast-agent", {"--id", std::to_string(id), "--modes", table});
  }
  Program& coordinator = hand("ergocast-coordinator", {scenario});
  ASSERT_TRUE(eventually([&] { return metric() < kCovered; }, driver.child.pid()))
      << driver.printed();
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  EXPECT_EQ(wait_for(driver.child), 0) << driver.printed();
  EXPECT_EQ(wait_for(logger.child), 0) << logger.printed();
  wait_for(coordinator.child);
  const json state = room.state();
  EXPECT_EQ(state["robot_contacts"], 0) << state;
  EXPECT_EQ(state["wall_contacts"], 0) << state;
  for (const json& robot : state["robots"]) {
    EXPECT_GT(robot["path"], 1) << state;
    EXPECT_LT(robot["speed"], 0.02) << state;
  }
  EXPECT_GE(summary()["separation"]["nearest_m"], 0.6);
  forget_watched();
  robots.send(SIGTERM);
  wait_for(robots);
}

}  // namespace
}  // namespace ergocast::test
