// SPDX-License-Identifier: BSD-3-Clause
// Mock robots behind cmd_vel and odom in a real team: agents over LCM, the bridge, and each robot
// in a DDS participant of its own.
#include "tests/process/support/mission.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "tests/bridges/order_socket.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

using nlohmann::json;

bool gets_zero(const json& state) { return state["command"] == json({0.0, 0.0, 0.0}); }
bool moves(const json& state) { return state["speed"] > 0.1; }
bool stands(const json& state) { return gets_zero(state) && state["speed"] < 1e-3; }

constexpr const char* kRobotZero = R"(
  robots {
    id: 0 drive: DIFFERENTIAL cmd_vel: "robot0/cmd_vel" odom: "robot0/odom" frame: "map"
    base_frame: "robot0/base_link" max_speed_mps: 1 max_turn_radps: 2
  })";
constexpr const char* kRobotOne = R"(
  robots {
    id: 1 drive: HOLONOMIC cmd_vel: "robot1/cmd_vel" pose: "robot1/pose" frame: "map"
    base_frame: "robot1/base_link" command_type: TWIST_STAMPED max_speed_mps: 1
  })";

class RosRobots : public ByHand {
 protected:
  static constexpr double kDistance_m = 2;

  /// Two robots over a floor of 20 m × 20 m.
  std::filesystem::path floor(const std::string& duration_s, int robots) const {
    const auto file = folder_ / "floor.textproto";
    std::ofstream(file) << "domain { size_x_m: 20 size_y_m: 20 }\n"
                           "target { gaussians { mean_x_m: 10 mean_y_m: 10 sigma_m: 4 } }\n"
                           "basis { modes_x: 8 modes_y: 8 }\n"
                           "law { u_max_mps: 1 anticipation: 0 }\n"
                           "time { dt_s: 0.1 pace: REALTIME command_hold_s: 0.4 "
                           "admission_timeout_s: 600 duration_s: "
                        << duration_s << " }\nagents { starts { x_m: 5 y_m: 5 } "
                        << (robots > 1 ? "starts { x_m: 15 y_m: 5 }" : "")
                        << " }\nworld { speed_limit_mps: 1 }\n"
                           "separation { distance_m: 2 lease_s: 3 response_s: 0.5 "
                           "position_error_m: 0.1 }\n";
    return file;
  }
  Program& bridge(const std::string& robots, const std::vector<std::string>& more = {}) {
    const auto file = folder_ / "bridge.textproto";
    std::ofstream(file) << "frames { name: \"map\" }\n" << robots << "\n";
    std::vector<std::string> arguments{file};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return hand("ergocast-ros2", arguments);
  }
  void mock(int port, const std::vector<std::string>& more, const std::string& kind = "cyclone") {
    std::vector<std::string> command{ERGOCAST_BIN_DIR "/mock-robot-" + kind, std::to_string(port)};
    command.insert(command.end(), more.begin(), more.end());
    mocks_.push_back(begin(command));
  }
  void mock_zero(const std::string& kind = "cyclone") {
    mock(14560, {"--name", "robot0", "--at", "5", "5"}, kind);
  }
  void mock_one(const std::string& kind = "cyclone") {
    mock(14561, {"--name", "robot1", "--at", "15", "5", "--pose", "--stamped"}, kind);
  }
  double least_distance_m() const {
    double least_m = std::numeric_limits<double>::max();
    for (const auto& [tick, rows] : recorded_rows(out())) {
      if (rows.size() < 2) continue;
      const RecordedRow &one = rows.at(0), &other = rows.at(1);
      least_m = std::min(least_m, std::hypot(one.x_m - other.x_m, one.y_m - other.y_m));
    }
    return least_m;
  }
  /// Two robots over a whole mission; in the end both have got zero and stand.
  void drive_a_whole_mission(const std::string& kind) {
    std::filesystem::create_directory(out());
    mock_zero(kind);
    mock_one(kind);
    const OrderSocket zero(14560), one(14561);
    Program& logger = hand("ergocast-logger", {"--out", out()});
    Program& display = bridge("display { prefix: \"ergocast\" frame: \"map\" }");
    EXPECT_TRUE(display.prints("to show it in ROS domain 0")) << display.printed();
    Program& driver = bridge(std::string(kRobotZero) + kRobotOne);
    EXPECT_TRUE(driver.prints("robot 0: waits for the mission")) << driver.printed();
    EXPECT_TRUE(driver.prints("robot 1: waits for the mission")) << driver.printed();
    EXPECT_EQ(zero.state()["commands"], 0) << "a person may drive it to its start";
    for (const char* id : {"0", "1"}) hand("ergocast-agent", {"--id", id});
    Program& coordinator = hand("ergocast-coordinator", {floor("20", 2)});
    EXPECT_EQ(wait_for(coordinator.child), 0) << coordinator.printed();
    EXPECT_EQ(wait_for(driver.child), 0) << driver.printed();
    EXPECT_EQ(wait_for(display.child), 0) << display.printed();
    EXPECT_EQ(wait_for(logger.child), 0) << logger.printed();
    EXPECT_TRUE(driver.prints("finished at tick 200: mission complete")) << driver.printed();
    EXPECT_EQ(summary()["result"], "done");
    EXPECT_EQ(summary()["ticks"], 200);
    for (const OrderSocket* robot : {&zero, &one}) {
      const json state = robot->state();
      EXPECT_TRUE(gets_zero(state)) << state;
      EXPECT_GT(state["commands"], 0) << state;
      EXPECT_EQ(state["timeouts"], 0) << state;
      EXPECT_TRUE(robot->sees(stands));
    }
    EXPECT_GE(least_distance_m(), kDistance_m);
  }

  void TearDown() override {
    forget_watched();
    for (Child& mock : mocks_) mock.send(SIGTERM);
    for (Child& mock : mocks_) wait_for(mock);
    ByHand::TearDown();
  }
  std::deque<Child> mocks_;
};

TEST_F(RosRobots, DriveAWholeMissionAndStandAtItsEnd) {
  drive_a_whole_mission("cyclone");
  const auto rows = recorded_rows(out());
  double way_m = 0;
  for (auto tick = std::next(rows.begin()); tick != rows.end(); ++tick) {
    const auto before = std::prev(tick)->second.find(1), now = tick->second.find(1);
    if (before == std::prev(tick)->second.end() || now == tick->second.end()) continue;
    way_m += std::hypot(now->second.x_m - before->second.x_m, now->second.y_m - before->second.y_m);
  }
  EXPECT_GT(way_m, 0.5) << "the record has what really moved";
}

#ifdef ERGOCAST_HAS_FAST_DDS
TEST_F(RosRobots, DriveAWholeMissionOnFastDds) { drive_a_whole_mission("fast"); }

/// The bytes that Fast DDS receives, read by Foxglove's reader with ROS 2's own definitions.
TEST_F(RosRobots, SendMessagesThatOthersCanRead) {
  std::filesystem::create_directory(out());
  mock_zero();
  mock_one();
  const OrderSocket one(14561);
  hand("ergocast-logger", {"--out", out()});
  Program& driver = bridge(std::string(kRobotZero) + kRobotOne +
                           "display { prefix: \"ergocast\" frame: \"map\" }");
  for (const char* id : {"0", "1"}) hand("ergocast-agent", {"--id", id});
  hand("ergocast-coordinator", {floor("1000000", 2)});
  ASSERT_TRUE(one.sees(moves)) << driver.printed();
  // The target was sent before this program began.
  const std::string file = folder_ / "recorded.json";
  Child recorder = begin({ERGOCAST_BIN_DIR "/fast-recorder",
                          file,
                          "robot0/cmd_vel",
                          "geometry_msgs::msg::dds_::Twist_",
                          "robot1/cmd_vel",
                          "geometry_msgs::msg::dds_::TwistStamped_",
                          "ergocast/coverage",
                          "nav_msgs::msg::dds_::OccupancyGrid_",
                          "ergocast/target",
                          "nav_msgs::msg::dds_::OccupancyGrid_",
                          "ergocast/left",
                          "nav_msgs::msg::dds_::OccupancyGrid_",
                          "ergocast/found",
                          "std_msgs::msg::dds_::Float64_",
                          "ergocast/finds",
                          "geometry_msgs::msg::dds_::PoseArray_",
                          "ergocast/contacts",
                          "geometry_msgs::msg::dds_::PoseArray_",
                          "ergocast/agent1/path",
                          "nav_msgs::msg::dds_::Path_",
                          "ergocast/phi2",
                          "std_msgs::msg::dds_::Float64_",
                          "ergocast/status",
                          "std_msgs::msg::dds_::String_"});
  EXPECT_EQ(wait_for(recorder), 0) << driver.printed();
  Child reader =
      begin({"/usr/bin/env", "node", ERGOCAST_SOURCE_DIR "/tests/bridges/ros2/reference/cdr.cjs",
             ERGOCAST_NODE_ROS2, "read", file});
  ASSERT_EQ(wait_for(reader), 0) << output();
  const json read = json::parse(output());
  EXPECT_EQ(read["robot0/cmd_vel"]["linear"]["y"], 0) << "a differential drive";
  EXPECT_LE(std::abs(read["robot1/cmd_vel"]["twist"]["linear"]["x"].get<double>()), 1);
  EXPECT_EQ(read["robot1/cmd_vel"]["header"]["frame_id"], "robot1/base_link");
  EXPECT_GT(read["robot1/cmd_vel"]["header"]["stamp"]["sec"], 1'700'000'000);
  for (const char* name : {"coverage", "target"}) {
    const json& grid = read[std::string("ergocast/") + name];
    EXPECT_EQ(grid["header"]["frame_id"], "map");
    EXPECT_EQ(grid["info"]["width"], 64);
    EXPECT_EQ(grid["info"]["height"], 64);
    EXPECT_EQ(grid["info"]["resolution"], 0.3125);
    EXPECT_EQ(grid["info"]["origin"]["orientation"]["w"], 1);
    const auto cells = grid["data"].get<std::vector<int>>();
    ASSERT_EQ(cells.size(), 64U * 64U);
    EXPECT_GE(*std::ranges::min_element(cells), 0);
    EXPECT_EQ(*std::ranges::max_element(cells), 100) << name;
    const std::size_t middle = 32 * 64 + 32, corner = 0;
    if (name == std::string("target")) {
      EXPECT_GT(cells[middle], 95);
      EXPECT_LT(cells[corner], 20);
    }
  }
  const auto left = read["ergocast/left"]["data"].get<std::vector<int>>();
  const auto target = read["ergocast/target"]["data"].get<std::vector<int>>();
  ASSERT_EQ(left.size(), target.size());
  EXPECT_LT(std::accumulate(left.begin(), left.end(), 0),
            std::accumulate(target.begin(), target.end(), 0));
  for (std::size_t i = 0; i < left.size(); ++i) EXPECT_LE(left[i], target[i]) << i;
  EXPECT_GT(read["ergocast/found"]["data"], 0);
  EXPECT_EQ(read["ergocast/finds"]["poses"], json::array());
  EXPECT_EQ(read["ergocast/contacts"]["header"]["frame_id"], "map");
  const json& path = read["ergocast/agent1/path"];
  ASSERT_FALSE(path["poses"].empty());
  EXPECT_NEAR(path["poses"][0]["pose"]["position"]["x"].get<double>(), 15, 2);
  EXPECT_EQ(path["poses"][0]["header"]["frame_id"], "map");
  EXPECT_GT(read["ergocast/phi2"]["data"], 0);
  const std::string status = read["ergocast/status"]["data"];
  EXPECT_NE(status.find("floor: running, tick "), status.npos) << status;
  EXPECT_NE(status.find("2 of 2 agents"), status.npos) << status;
}

/// Two rooms of 6 m × 8 m, as a message in JSON.
json two_rooms() {
  constexpr int kWidth = 120, kHeight = 80;
  std::vector<int> cells;
  for (int j = 0; j < kHeight; ++j)
    for (int i = 0; i < kWidth; ++i) {
      const bool edge = i < 2 || j < 2 || i >= kWidth - 2 || j >= kHeight - 2;
      const bool wall = (i == 60 || i == 61) && (j < 30 || j > 50);
      cells.push_back(edge || wall ? 100 : i > 100 && j > 70 ? -1 : 0);
    }
  const json zero = {{"x", 0}, {"y", 0}, {"z", 0}};
  return {{"header", {{"stamp", {{"sec", 1}, {"nanosec", 0}}}, {"frame_id", "map"}}},
          {"info",
           {{"map_load_time", {{"sec", 1}, {"nanosec", 0}}},
            {"resolution", 0.1},
            {"width", kWidth},
            {"height", kHeight},
            {"origin",
             {{"position", {{"x", -6}, {"y", -4.5}, {"z", 0}}},
              {"orientation", {{"x", 0}, {"y", 0}, {"z", 0}, {"w", 1}}}}}}},
          {"data", std::move(cells)}};
}

/// Foxglove's writer and Fast DDS publish it; what is saved passes `ergocast new` and `check`.
TEST_F(RosRobots, HaveScenariosInAMapOfATopic) {
  const auto publish = [&](const std::string& topic, const json& map,
                           const std::string& durability) {
    const std::string message = folder_ / (topic + ".json"), file = folder_ / topic;
    std::ofstream(message) << map;
    Child writer =
        begin({"/usr/bin/env", "node", ERGOCAST_SOURCE_DIR "/tests/bridges/ros2/reference/cdr.cjs",
               ERGOCAST_NODE_ROS2, "map", message});
    ASSERT_EQ(wait_for(writer), 0) << output();
    std::ofstream(file) << output();
    std::vector<std::string> sender{ERGOCAST_BIN_DIR "/fast-sender",       file, topic,
                                    "nav_msgs::msg::dds_::OccupancyGrid_", "1",  durability};
    mocks_.push_back(begin(sender));
  };
  const auto save = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command{ERGOCAST_BIN_DIR "/ergocast-ros2", "map"};
    command.insert(command.end(), more.begin(), more.end());
    Child child = begin(command);
    return wait_for(child);
  };
  const json rooms = two_rooms();
  publish("map", rooms, "latched");
  const std::string yaml = folder_ / "rooms.yaml";
  ASSERT_EQ(save({"--save", yaml, "--wait", "3600"}), 0) << output();
  EXPECT_NE(output().find("ergocast new --map " + yaml), std::string::npos) << output();
  const std::string scenario = folder_ / "rooms.textproto";
  ASSERT_EQ(ergocast({"new", "--map", yaml, "--robots", "2", "--out", scenario}), 0) << output();
  EXPECT_NE(text_of(scenario).find("walls { file: \"rooms.yaml\" }"), std::string::npos)
      << text_of(scenario);
  EXPECT_EQ(ergocast({"check", scenario}), 0) << output();

  EXPECT_EQ(save({"--save", yaml}), 2);
  EXPECT_NE(output().find("rooms.yaml is there already"), std::string::npos) << output();
  const std::string other = folder_ / "other.yaml";
  EXPECT_EQ(save({"--save", other, "--frame", "odom", "--wait", "3600"}), 2);
  EXPECT_NE(output().find("map is in the frame 'map', not in 'odom'"), std::string::npos)
      << output();
  json bad = rooms;
  bad["data"][121] = 101;
  publish("bad_map", bad, "latched");
  EXPECT_EQ(save({"--save", other, "--topic", "/bad_map", "--wait", "3600"}), 2);
  EXPECT_NE(output().find("bad_map has the value 101 in cell (1, 1)"), std::string::npos)
      << output();
  publish("passing_map", rooms, "volatile");
  EXPECT_EQ(save({"--save", other, "--topic", "passing_map", "--wait", "3600"}), 3);
  EXPECT_NE(output().find("QoS of passing_map does not match, durability: its publisher offers "
                          "VOLATILE, the bridge requests TRANSIENT_LOCAL"),
            std::string::npos)
      << output();
  EXPECT_EQ(save({"--save", other, "--topic", "none", "--wait", "0.5"}), 3);
  EXPECT_NE(output().find("no map came: nobody publishes none"), std::string::npos) << output();
  EXPECT_EQ(save({"--save", other, "--topic", "no topic"}), 2);
  EXPECT_FALSE(std::filesystem::exists(other));
}

/// Foxglove's writer makes an Odometry; then each shorter one and damaged ones arrive between.
TEST_F(RosRobots, TakeMessagesOfAnotherWriterAndSurviveDamagedOnes) {
  Child writer =
      begin({"/usr/bin/env", "node", ERGOCAST_SOURCE_DIR "/tests/bridges/ros2/reference/cdr.cjs",
             ERGOCAST_NODE_ROS2, "write"});
  ASSERT_EQ(wait_for(writer), 0) << output();
  const std::string whole = output().substr(0, output().find('\n'));
  ASSERT_GT(whole.size(), 1000U);
  const auto send = [&](const std::vector<std::string>& messages, int times) {
    const std::string file = folder_ / "messages";
    std::ofstream out(file);
    for (const std::string& message : messages) out << message << '\n';
    out.close();
    Child sender = begin({ERGOCAST_BIN_DIR "/fast-sender", file, "robot0/odom",
                          "nav_msgs::msg::dds_::Odometry_", std::to_string(times)});
    EXPECT_EQ(wait_for(sender), 0);
  };
  mock(14560, {"--name", "robot0", "--topic", "other"});
  Program& driver = bridge(kRobotZero);
  EXPECT_TRUE(driver.prints("robot 0: nobody publishes robot0/odom"));
  std::vector<std::string> damaged;
  for (std::size_t size = 2; size < whole.size(); size += 26)
    damaged.push_back(whole.substr(0, size));
  for (const std::size_t at : {0U, 2U, 24U, 40U, 96U}) {
    damaged.push_back(whole);
    damaged.back().replace(at, 8, "ffffff7f");
  }
  send(damaged, 2);
  EXPECT_EQ(driver.printed().find("waits for the mission"), std::string::npos) << driver.printed();
  send({whole}, 100);
  EXPECT_TRUE(driver.prints("robot 0: waits for the mission")) << driver.printed();
  driver.child.send(SIGTERM);
  EXPECT_EQ(wait_for(driver.child), 0) << driver.printed();
}
#endif

/// A mission that does not end, with robot 0 alone.
class OneRosRobot : public RosRobots {
 protected:
  void SetUp() override {
    RosRobots::SetUp();
    std::filesystem::create_directory(out());
    mock_zero();
    robot_ = std::make_unique<OrderSocket>(14560);
    hand("ergocast-logger", {"--out", out()});
    driver_ = &bridge(kRobotZero);
    agent_ = &hand("ergocast-agent", {"--id", "0"});
    hand("ergocast-coordinator", {floor("1000000", 1)});
    ASSERT_TRUE(robot_->sees(moves)) << driver_->printed();
  }
  /// After the order the bridge prints why, and the robot stands; after "good" it moves again.
  void stands_after(const std::string& order, const std::string& why) {
    const std::size_t before = driver_->printed().size();
    robot_->orders(order);
    const auto prints = [&](const std::string& part) {
      return eventually([&] { return driver_->printed().find(part, before) != std::string::npos; },
                        driver_->child.pid());
    };
    EXPECT_TRUE(prints(why)) << order << ": " << driver_->printed();
    EXPECT_TRUE(robot_->sees(stands)) << order;
    robot_->orders("good");
    EXPECT_TRUE(prints("robot 0: follows its agent")) << order << ": " << driver_->printed();
    EXPECT_TRUE(robot_->sees(moves)) << order;
  }

  std::unique_ptr<OrderSocket> robot_;
  Program* driver_ = nullptr;
  Program* agent_ = nullptr;
};

TEST_F(OneRosRobot, StandsWhileItsPositionCannotBeTrusted) {
  stands_after("frame odom",
               "robot0/odom is in the frame 'odom', and this bridge's file says "
               "frame: 'map'");
  stands_after("base base_link",
               "robot0/odom is of the frame 'base_link', and this bridge's file "
               "says base_frame: 'robot0/base_link'");
  stands_after("nan", "robot0/odom has a value that is no number");
  stands_after("clock -1000", "s before this machine's clock: synchronise the clocks");
  stands_after("clock 1000", "s in the future: synchronise the clocks");
  stands_after("silent",
               "robot0/odom is silent or too slow: its newest position is older than 0.5 s");
  stands_after("jump 3", "robot0/odom jumped by");
  stands_after("second", "2 publishers are on robot0/odom");
}

TEST_F(OneRosRobot, StandsWithoutItsAgentAndAfterASignal) {
  agent_->child.send(SIGSTOP);
  EXPECT_TRUE(robot_->sees(stands)) << driver_->printed();
  const int commands = robot_->state()["commands"];
  EXPECT_TRUE(robot_->sees([&](const json& state) { return state["commands"] > commands + 20; }))
      << "zero is still sent";
  agent_->child.send(SIGCONT);
  EXPECT_TRUE(robot_->sees(moves)) << driver_->printed();
  driver_->child.send(SIGTERM);
  EXPECT_EQ(wait_for(driver_->child), 0) << driver_->printed();
  EXPECT_TRUE(gets_zero(robot_->state()));
  EXPECT_TRUE(robot_->sees(stands));
}

TEST_F(OneRosRobot, StandsAtOnceAfterAStop) {
  ASSERT_EQ(ergocast({"stop", "--now", "--lcm-url", kUrl}), 0) << output();
  EXPECT_EQ(wait_for(driver_->child), 0) << driver_->printed();
  EXPECT_TRUE(gets_zero(robot_->state()));
  EXPECT_TRUE(robot_->sees(stands));
  const auto rows = recorded_rows(out());
  ASSERT_FALSE(rows.empty());
  for (const auto& [id, row] : rows.rbegin()->second) EXPECT_TRUE(row.stands()) << id;
}

TEST_F(OneRosRobot, HasOneBridge) {
  Program& second = bridge(kRobotZero);
  EXPECT_EQ(wait_for(second.child), 4) << second.printed();
  EXPECT_TRUE(second.prints("robot 0 is driven by another driver already")) << second.printed();
  EXPECT_TRUE(driver_->prints("another program publishes robot0/cmd_vel, too"))
      << driver_->printed();
  EXPECT_TRUE(robot_->sees(moves));
}

TEST_F(RosRobots, HaveAnExampleOfAScenario) {
  EXPECT_EQ(ergocast({"check", ERGOCAST_SOURCE_DIR "/examples/ros2/floor.textproto"}), 0)
      << output();
}

TEST_F(RosRobots, NameBothSidesOfATopicThatDoesNotConnect) {
  mock(14560, {"--name", "robot0", "--latched-commands"});
  mock(14561, {"--name", "robot1", "--topic", "robot1/pose", "--stamped"});
  mock(14562, {"--name", "robot2", "--best-effort"});
  mock(14563, {"--name", "robot3", "--stamped"});
  const auto more = [](const std::string& number, const std::string& fields) {
    return "robots { id: " + number + " drive: HOLONOMIC cmd_vel: \"robot" + number +
           "/cmd_vel\" odom: \"robot" + number + "/odom\" frame: \"map\" max_speed_mps: 1 " +
           fields + " }\n";
  };
  Program& driver = bridge(std::string(kRobotZero) + kRobotOne +
                           more("2", "reliability: RELIABLE") + more("3", "") + more("4", ""));
  for (
      const char* sentence :
      {"robot 0: QoS of robot0/cmd_vel does not match, durability: the bridge offers VOLATILE, its "
       "subscriber requests TRANSIENT_LOCAL",
       "robot 1: robot1/pose is published as nav_msgs/msg/Odometry, the bridge expects "
       "geometry_msgs/msg/PoseStamped",
       "robot 2: QoS of robot2/odom does not match, reliability: its publisher offers BEST_EFFORT, "
       "the bridge requests RELIABLE",
       "robot 3: a subscriber of robot3/cmd_vel expects geometry_msgs/msg/TwistStamped, the bridge "
       "sends geometry_msgs/msg/Twist",
       "robot 4: nobody publishes robot4/odom"})
    EXPECT_TRUE(driver.prints(sentence)) << sentence << '\n' << driver.printed();
}

}  // namespace
}  // namespace ergocast::test
