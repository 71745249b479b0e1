// SPDX-License-Identifier: BSD-3-Clause
// How the scenario's speed limit cuts a command.
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

#include "core/motion/vehicle.h"

namespace ergocast {
namespace {

Motion limited(double speed_limit_mps) {
  Motion motion;
  motion.speed_limit_mps = speed_limit_mps;
  return motion;
}

bool same_bits(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::bit_cast<std::uint64_t>(a.x()) == std::bit_cast<std::uint64_t>(b.x()) &&
         std::bit_cast<std::uint64_t>(a.y()) == std::bit_cast<std::uint64_t>(b.y());
}

TEST(SpeedLimit, LeavesEveryBitOfWhatItAllows) {
  for (const Eigen::Vector3d& v :
       {Eigen::Vector3d(0, -0.0, 0), {3, -4, 0}, {0.1, 4.9, 0}, {5e-324, 0, 0}, {-5, 0, 0}}) {
    EXPECT_TRUE(same_bits(within_speed_limit(limited(5), v), v)) << v.transpose();
    EXPECT_TRUE(same_bits(within_speed_limit(limited(0), v * 1e9), v * 1e9)) << "none";
  }
}

TEST(SpeedLimit, CutsTheRestAndKeepsTheDirection) {
  const double most = std::numeric_limits<double>::max();
  for (const Eigen::Vector3d& v :
       {Eigen::Vector3d(6, 8, 0), {-0.003, 5.1, 0}, {1e300, -1e300, 0}, {most, most, 0}}) {
    const Eigen::Vector3d cut = within_speed_limit(limited(5), v);
    EXPECT_NEAR(cut.norm(), 5, 1e-14) << v.transpose();
    EXPECT_NEAR(std::atan2(cut.y(), cut.x()), std::atan2(v.y(), v.x()), 1e-15) << v.transpose();
  }
}

TEST(SpeedLimit, InSpaceCountsAllThreeAxes) {
  Motion motion = limited(7);
  motion.domain.size_m.z() = 1;
  const Eigen::Vector3d allowed(2, 3, 6), fast(4, 6, 12);
  EXPECT_EQ(within_speed_limit(motion, allowed), allowed);
  EXPECT_LT((within_speed_limit(motion, fast) - allowed).norm(), 1e-14);
}

TEST(SpeedLimit, InAPlaneNothingMovesAlongZ) {
  for (const double limit_mps : {0.0, 5.0}) {
    EXPECT_EQ(within_speed_limit(limited(limit_mps), {3, 4, 100}), Eigen::Vector3d(3, 4, 0));
  }
}

}  // namespace
}  // namespace ergocast
