// SPDX-License-Identifier: BSD-3-Clause
// The bridge's file: its content, and a sentence with file, line and field for each mistake.
#include "bridges/ros2/bridge_file.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ergocast::ros2 {
namespace {

const std::string kGood = R"(# a comment
domain_id: 7
frames { name: "map" }
frames { name: "robot1/odom" x_m: 3 y_m: 4 yaw_deg: 90 }
robots {
  id: 1
  drive: DIFFERENTIAL
  cmd_vel: "/robot1/cmd_vel"
  odom: "robot1/odom"
  frame: "robot1/odom"
  base_frame: "robot1/base_link"
  max_speed_mps: 0.5
  max_turn_radps: 2
}
robots { id: 0 drive: HOLONOMIC cmd_vel: "a/b" pose: "a/c" frame: "map" max_speed_mps: 2 }
display { prefix: "ergocast" frame: "map" }
)";

std::string changed(const std::string& from, const std::string& to) {
  std::string text = kGood;
  const auto at = text.find(from);
  EXPECT_NE(at, text.npos) << from;
  return text.replace(at, from.size(), to);
}

TEST(BridgeFile, HasRobotsFramesAndADisplay) {
  const auto file = parse_bridge_file(kGood, "b");
  ASSERT_TRUE(file) << file.error();
  EXPECT_EQ(file->domain_id, 7);
  ASSERT_EQ(file->robots.size(), 2U);
  EXPECT_EQ(file->robots[0].id, 0);
  EXPECT_FALSE(file->robots[0].topics.has_odometry);
  const BridgedRobot& robot = file->robots[1];
  EXPECT_EQ(robot.topics.cmd_vel, "robot1/cmd_vel");
  EXPECT_EQ(robot.frame.origin_m, Eigen::Vector3d(3, 4, 0));
  EXPECT_NEAR(robot.frame.yaw_rad, M_PI / 2, 1e-12);
  EXPECT_EQ(file->display->prefix, "ergocast");
}

TEST(BridgeFile, OfTheExampleIsRight) {
  const auto file = read_bridge_file(ERGOCAST_SOURCE_DIR "/examples/ros2/two_robots.textproto");
  ASSERT_TRUE(file) << file.error();
  EXPECT_EQ(file->robots.size(), 2U);
}

TEST(BridgeFile, NamesLineAndFieldOfWhatIsWrong) {
  const std::array<std::array<std::string, 3>, 22> wrong{{
      {"frame: \"robot1/odom\"", "frame: \"odom\"",
       "b:10: robots[0].frame: 'odom' is none of frames { } (map, robot1/odom)"},
      {"  frame: \"robot1/odom\"\n", "", "b:5: robots[0].frame: is missing"},
      {"  id: 1\n", "", "b:5: robots[0].id: is missing; the number of the robot's agent"},
      {"id: 1\n", "id: 1024\n", "b:6: robots[0].id: 1024 is not from 0 to 1023"},
      {"id: 1\n", "id: 0\n", "b:15: robots[1].id: '0' is there twice"},
      {"drive: DIFFERENTIAL\n", "\n", "b:5: robots[0].drive: is missing"},
      {"max_speed_mps: 0.5", "max_speed_mps: -1",
       "b:12: robots[0].max_speed_mps: -1 is not from 0 to 100"},
      {"max_speed_mps: 0.5", "max_speed_mps: nan", "b:12: robots[0].max_speed_mps: nan is not"},
      {"max_turn_radps: 2", "", "b:5: robots[0].max_turn_radps: is missing"},
      {"\"/robot1/cmd_vel\"", "\"robot 1\"", "b:8: robots[0].cmd_vel: 'robot 1' is no topic"},
      {"\"/robot1/cmd_vel\"", "\"1/a\"", "is no topic of ROS 2"},
      {"\"/robot1/cmd_vel\"", "\"a/\"", "is no topic of ROS 2"},
      {"\"/robot1/cmd_vel\"", "\"a/b\"", "b:15: robots[1].cmd_vel: 'a/b' is there twice"},
      {"  odom: \"robot1/odom\"\n", "", "robots[0].odom: is missing; name a topic"},
      {"pose: \"a/c\"", "pose: \"a/c\" odom: \"a/d\"", "robots[1].pose: the robot has odom, too"},
      {"name: \"map\"", "name: \"robot1/odom\"",
       "b:4: frames[1].name: 'robot1/odom' is there twice; leave one out"},
      {"x_m: 3", "x_m: inf", "b:4: frames[1].x_m: inf is not from"},
      {"domain_id: 7", "domain_id: 233", "b:2: domain_id: 233 is not from 0 to 232"},
      {"prefix: \"ergocast\" frame: \"map\"", "prefix: \"e\" frame: \"robot1/odom\"",
       "b:16: display.frame: 'robot1/odom' is turned"},
      {"pose: \"a/c\"", "command_type: TWIST_STAMPED pose: \"a/c\"",
       "robots[1].command_type: TWIST_STAMPED needs base_frame"},
      {"max_speed_mps: 2", "max_speed_mps: 2 max_turn_radps: 1",
       "robots[1].max_turn_radps: a HOLONOMIC robot is not turned"},
      {"drive: DIFFERENTIAL", "drives: DIFFERENTIAL", "b:7: "},
  }};
  for (const auto& [from, to, sentence] : wrong) {
    const auto file = parse_bridge_file(changed(from, to), "b");
    ASSERT_FALSE(file) << to;
    EXPECT_NE(file.error().find(sentence), std::string::npos) << file.error();
  }
  EXPECT_EQ(parse_bridge_file("", "b").error(),
            "b:1: robots: there is no robot and no display; add robots { } or display { }");
  for (const char* text : {"\x80", "robots {", "frames { name: \"\xff\" }", "}"})
    EXPECT_FALSE(parse_bridge_file(text, "b")) << text;
  EXPECT_FALSE(read_bridge_file("/no/such/file"));
}

}  // namespace
}  // namespace ergocast::ros2
