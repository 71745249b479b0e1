// SPDX-License-Identifier: BSD-3-Clause
// The rule that turns a point's velocity into that of a robot.
#include "bridges/ros2/steering.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ergocast::ros2 {
namespace {

constexpr DriveLimits kDisc{DriveKind::kDifferential, 1, 2};
constexpr DriveLimits kHolonomic{DriveKind::kHolonomic, 1, 0};

TEST(Steering, TurnsTheVelocityIntoTheAxesOfAHolonomicRobot) {
  const BodyVelocity body = body_velocity(kHolonomic, M_PI / 2, {0.3, 0.4, 0.1}, true);
  EXPECT_TRUE(body.linear_mps.isApprox(Eigen::Vector3d(0.4, -0.3, 0.1), 1e-12));
  EXPECT_EQ(body.turn_radps, 0);
}

TEST(Steering, KeepsTheRobotsOwnLimits) {
  EXPECT_NEAR(body_velocity(kHolonomic, 0.3, {30, 40, 0}, true).linear_mps.norm(), 1, 1e-12);
  EXPECT_NEAR(body_velocity(kDisc, 0, {5, 0, 0}, true).linear_mps.x(), 1, 1e-12);
  EXPECT_EQ(body_velocity(kDisc, 0, {-1, 1e-9, 0}, false).turn_radps, 2);
  EXPECT_EQ(body_velocity(kDisc, 0, {-1, -1e-9, 0}, false).turn_radps, -2);
}

TEST(Steering, StandsForNoVelocity) {
  for (const DriveLimits& limits : {kDisc, kHolonomic})
    EXPECT_TRUE(body_velocity(limits, 1, {0, 0, 0}, true).stands());
}

/// For each heading: a disc never moves away from its command, and not far aside where it must not.
TEST(Steering, DrivesOnlyWhereItIsSafe) {
  const Eigen::Vector3d wanted_mps(0.6, -0.8, 0);
  const Eigen::Vector3d aside(0.8, 0.6, 0);
  for (double heading_rad = -7; heading_rad < 7; heading_rad += 0.01) {
    const Eigen::Vector3d look(std::cos(heading_rad), std::sin(heading_rad), 0);
    for (const bool exactly : {false, true}) {
      const BodyVelocity body = body_velocity(kDisc, heading_rad, wanted_mps, exactly);
      const Eigen::Vector3d moves_mps = body.linear_mps.x() * look;
      EXPECT_GE(body.linear_mps.x(), 0);
      EXPECT_EQ(body.linear_mps.y(), 0);
      EXPECT_GE(moves_mps.dot(wanted_mps), 0) << heading_rad;
      EXPECT_LE(moves_mps.norm(), wanted_mps.norm() + 1e-12);
      if (exactly) {
        EXPECT_LE(std::abs(moves_mps.dot(aside)), 0.05) << heading_rad;
      }
      const Eigen::Vector3d later(std::cos(heading_rad + 0.01 * body.turn_radps),
                                  std::sin(heading_rad + 0.01 * body.turn_radps), 0);
      EXPECT_GE(later.dot(wanted_mps), look.dot(wanted_mps) - 1e-9) << "it turns towards it";
    }
  }
}

}  // namespace
}  // namespace ergocast::ros2
