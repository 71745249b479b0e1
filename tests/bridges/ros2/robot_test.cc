// SPDX-License-Identifier: BSD-3-Clause
// When a robot is sent which velocity.
#include "bridges/ros2/robot.h"

#include <gtest/gtest.h>

#include <vector>

namespace ergocast::ros2 {
namespace {

constexpr auto kMillisecond = std::chrono::milliseconds(1);

class RosRobot : public ::testing::Test {
 protected:
  /// Passes `ms` with a position every 20 ms; notes what is sent.
  void pass(int ms, double speed_mps = 0) {
    for (int i = 0; i < ms; ++i, at_.now += kMillisecond, at_.wall_ns += 1'000'000) {
      if (positions_ && i % 20 == 0) robot_.take(position(speed_mps), at_);
      if (const auto velocity = robot_.due(at_.now)) sent_.push_back({at_.now, *velocity});
    }
  }
  PoseMessage position(double speed_mps) const {
    PoseMessage message;
    message.stamp_ns = at_.wall_ns;
    message.frame = "map";
    message.position_m = {5, 5, 0};
    message.body_velocity_mps = Eigen::Vector3d(speed_mps, 0, 0);
    return message;
  }
  void begin() { robot_.begin({{0, 0, 0}, {10, 10, 0}}, 0.6, true); }

  struct Sent {
    Instant at;
    BodyVelocity velocity;
  };
  Moment at_{Instant(std::chrono::seconds(1)), 1'700'000'000'000'000'000};
  bool positions_ = true;
  Robot robot_{{DriveKind::kDifferential, 1, 2}, Positions("odom", {"map"}, "", 1)};
  std::vector<Sent> sent_;
};

TEST_F(RosRobot, IsSentNothingBeforeTheMission) {
  pass(1000);
  EXPECT_TRUE(sent_.empty());
  EXPECT_EQ(robot_.why_not(at_.now), "waits for the mission");
  robot_.finish();
  EXPECT_TRUE(robot_.done());
}

TEST_F(RosRobot, IsSentEachVelocityAtOnceAndTwentyTimesASecond) {
  begin();
  pass(1000);
  ASSERT_EQ(sent_.size(), 20U);
  robot_.go({0.5, 0, 0});
  pass(1);
  ASSERT_EQ(sent_.size(), 21U);
  EXPECT_EQ(sent_.back().velocity.linear_mps.x(), 0.5);
  pass(1000);
  for (std::size_t i = 1; i < sent_.size(); ++i)
    EXPECT_LE(sent_[i].at - sent_[i - 1].at, 50 * kMillisecond) << i;
}

TEST_F(RosRobot, IsSentZeroWhileItMustNotMove) {
  begin();
  robot_.go({0.5, 0, 0});
  pass(100);
  EXPECT_FALSE(sent_.back().velocity.stands());
  robot_.set_topic_problem("2 publishers are on odom");
  pass(60);
  EXPECT_TRUE(sent_.back().velocity.stands());
  EXPECT_FALSE(robot_.fix(at_.now)) << "the team must not use it";
  robot_.set_topic_problem("");
  pass(60);
  EXPECT_FALSE(sent_.back().velocity.stands());
  positions_ = false;
  pass(700);
  EXPECT_TRUE(sent_.back().velocity.stands());
  const std::size_t before = sent_.size();
  pass(1000);
  EXPECT_EQ(sent_.size(), before + 20) << "zero is repeated";
}

TEST_F(RosRobot, StandsFarOutsideOfTheDomain) {
  robot_.begin({{100, 100, 0}, {10, 10, 0}}, 0.6, true);
  robot_.go({0.5, 0, 0});
  pass(100);
  EXPECT_TRUE(sent_.back().velocity.stands());
  EXPECT_EQ(robot_.why_not(at_.now),
            "is far outside of the domain: is the origin of its frame right?");
}

TEST_F(RosRobot, IsSentZeroAtTheEndUntilItStands) {
  begin();
  robot_.go({0.5, 0, 0});
  pass(100, 0.5);
  sent_.clear();
  robot_.finish();
  pass(2000, 0.5);
  EXPECT_FALSE(robot_.done());
  EXPECT_EQ(sent_.size(), 40U);
  pass(200);
  EXPECT_TRUE(robot_.done());
  for (const Sent& one : sent_) EXPECT_TRUE(one.velocity.stands());
  sent_.clear();
  pass(1000);
  EXPECT_TRUE(sent_.empty());
}

TEST_F(RosRobot, ThatNeverStandsIsGivenUp) {
  begin();
  robot_.finish();
  pass(11000, 0.5);
  EXPECT_TRUE(robot_.done());
  EXPECT_EQ(sent_.size(), 200U);
}

}  // namespace
}  // namespace ergocast::ros2
