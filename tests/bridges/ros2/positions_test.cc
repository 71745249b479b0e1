// SPDX-License-Identifier: BSD-3-Clause
// Which positions count, and the sentences about those that do not.
#include "bridges/ros2/positions.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace ergocast::ros2 {
namespace {

constexpr std::int64_t kStart_ns = 1'700'000'000'000'000'000;

class RosPositions : public ::testing::Test {
 protected:
  RosPositions() { advance(0); }
  void advance(double s) {
    const auto step = static_cast<std::int64_t>(s * 1e9);
    at_.wall_ns = (at_.wall_ns == 0 ? kStart_ns : at_.wall_ns) + step;
    at_.now += std::chrono::nanoseconds(step);
  }
  PoseMessage odometry(double x_m, double y_m) const {
    PoseMessage message;
    message.stamp_ns = at_.wall_ns;
    message.frame = "robot0/odom";
    message.child_frame = "robot0/base_link";
    message.position_m = {x_m, y_m, 0};
    message.body_velocity_mps = Eigen::Vector3d(0.5, 0, 0);
    return message;
  }
  /// The problem after a message with a new stamp, changed by `change`.
  std::string problem_of(double x_m, const std::function<void(PoseMessage&)>& change = {}) {
    advance(0.02);
    PoseMessage message = odometry(x_m, 0);
    if (change) change(message);
    positions_.take(message, at_);
    return positions_.problem(at_.now);
  }

  Moment at_;
  Positions positions_{
      "robot0/odom", {"robot0/odom", {10, 20, 0}, M_PI / 2}, "robot0/base_link", 1};
};

TEST_F(RosPositions, AreTurnedIntoTheScenariosFrame) {
  EXPECT_EQ(positions_.problem(at_.now), "nothing has arrived on robot0/odom");
  positions_.take(odometry(1, 2), at_);
  const auto fix = positions_.at(at_.now);
  ASSERT_TRUE(fix);
  EXPECT_TRUE(fix->position_m.isApprox(Eigen::Vector3d(8, 21, 0), 1e-12));
  EXPECT_NEAR(fix->heading_rad, M_PI / 2, 1e-12);
  EXPECT_TRUE(fix->velocity_mps.isApprox(Eigen::Vector3d(0, 0.5, 0), 1e-12));
  EXPECT_EQ(fix->measured, at_.now);
}

TEST_F(RosPositions, WithoutAVelocityHaveThatOfTheLastTwo) {
  PoseMessage pose = odometry(0, 0);
  pose.body_velocity_mps.reset();
  positions_.take(pose, at_);
  advance(0.1);
  pose = odometry(0.05, 0);
  pose.body_velocity_mps.reset();
  positions_.take(pose, at_);
  EXPECT_TRUE(positions_.at(at_.now)->velocity_mps.isApprox(Eigen::Vector3d(0, 0.5, 0), 1e-6));
}

TEST_F(RosPositions, AreRefusedWithASentenceEach) {
  ASSERT_EQ(problem_of(0), "");
  const auto says = [&](const std::function<void(PoseMessage&)>& change,
                        const std::string& sentence) {
    EXPECT_NE(problem_of(0, change).find(sentence), std::string::npos)
        << positions_.problem(at_.now);
    EXPECT_FALSE(positions_.at(at_.now));
    EXPECT_EQ(problem_of(0), "");
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  says([](PoseMessage& m) { m.frame = "map"; }, "is in the frame 'map'");
  says([](PoseMessage& m) { m.frame = std::string(5000, 'x') + "\n\x1b"; }, "xxx…'");
  says([](PoseMessage& m) { m.frame = "a\nb\x1b[2J"; }, "'a b\\x1b[2J'");
  says([](PoseMessage& m) { m.child_frame = "base"; }, "is of the frame 'base'");
  says([&](PoseMessage& m) { m.position_m.x() = nan; }, "no number");
  says([&](PoseMessage& m) { m.orientation[3] = nan; }, "no number");
  says([&](PoseMessage& m) { m.body_velocity_mps->y() = HUGE_VAL; }, "no number");
  says([](PoseMessage& m) { m.orientation = {0, 0, 0, 0}; }, "no unit quaternion");
  says([](PoseMessage& m) { m.stamp_ns = 0; }, "has no stamp");
  says([](PoseMessage& m) { m.stamp_ns = 5'000'000'000; }, "use no simulated time");
  says([&](PoseMessage& m) { m.stamp_ns = at_.wall_ns + 1'000'000'000; }, "in the future");
}

TEST_F(RosPositions, AreTooOldAfterHalfASecond) {
  positions_.take(odometry(0, 0), at_);
  advance(0.45);
  EXPECT_TRUE(positions_.at(at_.now));
  advance(0.1);
  EXPECT_FALSE(positions_.at(at_.now));
  EXPECT_EQ(positions_.problem(at_.now),
            "robot0/odom is silent or too slow: its newest position is older than 0.5 s");
  positions_.take(odometry(0, 0), at_);
  EXPECT_TRUE(positions_.at(at_.now));
  positions_.set_oldest(0.2);
  advance(0.3);
  EXPECT_FALSE(positions_.at(at_.now));
}

TEST_F(RosPositions, WaitAfterAJumpUntilTheyAreSteady) {
  ASSERT_EQ(problem_of(0), "");
  EXPECT_EQ(problem_of(0.5), "") << "no more than the limit";
  EXPECT_NE(problem_of(3).find("jumped by 2.5 m"), std::string::npos);
  for (int i = 0; i < 140; ++i) EXPECT_NE(problem_of(3), "") << i;
  for (int i = 0; i < 20; ++i) problem_of(3);
  EXPECT_EQ(problem_of(3), "");
}

TEST_F(RosPositions, ThatWereOvertakenHaveNoEffect) {
  const PoseMessage old = odometry(1, 0);
  advance(0.1);
  positions_.take(odometry(1.05, 0), at_);
  positions_.take(old, at_);
  EXPECT_NEAR(positions_.at(at_.now)->position_m.y(), 21.05, 1e-12);
}

}  // namespace
}  // namespace ergocast::ros2
