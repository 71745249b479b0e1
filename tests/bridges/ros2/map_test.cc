// SPDX-License-Identifier: BSD-3-Clause
// Maps of ROS 2 as files: the reader of occupancy maps finds what the message had.
#include "bridges/ros2/map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <vector>

#include "target/maps/occupancy_map.h"
#include "tests/support/temp_folder.h"

namespace ergocast::ros2 {
namespace {

using Cells = std::vector<std::uint8_t>;

class MapOfATopic : public ::testing::Test {
 protected:
  MapOfATopic() {
    message_.frame = "map";
    message_.resolution_m = 0.05F;
    message_.width = 3;
    message_.height = 2;
    message_.origin_m = {-1.5, 2, 0};
    message_.data = data_;
  }
  Result<SavedMap> save(MapMode mode = MapMode::kTrinary) const {
    return save_map(message_, "map", "map", "rooms.pgm", mode);
  }
  std::string error() const {
    const auto saved = save();
    return saved ? "" : saved.error();
  }
  OccupancyMap reopened(MapMode mode = MapMode::kTrinary) const {
    const auto saved = save(mode);
    EXPECT_TRUE(saved) << saved.error();
    std::ofstream(folder_.path() / "rooms.pgm", std::ios::binary) << saved->picture;
    std::ofstream(folder_.path() / "rooms.yaml") << saved->yaml;
    auto map = OccupancyMap::open(folder_.path() / "rooms.yaml");
    EXPECT_TRUE(map) << map.error().what;
    return *std::move(map);
  }

  const test::TempFolder folder_;
  std::vector<std::int8_t> data_{0, 100, -1, 65, 25, 50};
  MapMessage message_;
};

TEST_F(MapOfATopic, IsReadAsItWas) {
  OccupancyMap map = reopened();
  EXPECT_EQ(map.about().resolution_m, 0.05);
  EXPECT_EQ(map.about().origin_m, Eigen::Vector2d(-1.5, 2));
  EXPECT_EQ(map.about().yaw_rad, 0);
  ASSERT_EQ(map.columns(), 3);
  ASSERT_EQ(map.rows(), 2);
  Cells row(3);
  ASSERT_FALSE(map.next_row(row));  // the northern one
  EXPECT_EQ(row, (Cells{kOccupiedCell, kFreeCell, kUnknownCell}));
  ASSERT_FALSE(map.next_row(row));
  EXPECT_EQ(row, (Cells{kFreeCell, kOccupiedCell, kUnknownCell}));
  EXPECT_EQ(save()->unknown, 1U);
}

TEST_F(MapOfATopic, HasTheSameWallsInBothModes) {
  OccupancyMap map = reopened(MapMode::kRaw);
  Cells row(3);
  ASSERT_FALSE(map.next_row(row));
  EXPECT_EQ(row, (Cells{kOccupiedCell, kFreeCell, kUnknownCell}));
  ASSERT_FALSE(map.next_row(row));
  EXPECT_EQ(row, (Cells{kFreeCell, kOccupiedCell, kUnknownCell}));
}

TEST_F(MapOfATopic, KeepsPercentagesForATarget) {
  OccupancyMap map = reopened(MapMode::kRaw);
  std::vector<double> row(3);
  ASSERT_FALSE(map.next_percents(row));
  EXPECT_EQ(row, (std::vector<double>{65, 25, 50}));
  ASSERT_FALSE(map.next_percents(row));
  EXPECT_EQ(row, (std::vector<double>{0, 100, 0}));  // unknown: 0
}

TEST_F(MapOfATopic, MayBeTurned) {
  message_.orientation = {0, 0, std::sin(0.2), std::cos(0.2)};
  EXPECT_NEAR(reopened().about().yaw_rad, 0.4, 1e-12);
  message_.orientation *= -1;  // the same turn
  EXPECT_NEAR(reopened().about().yaw_rad, 0.4, 1e-12);
}

TEST_F(MapOfATopic, IsRefusedWithTheFieldThatIsWrong) {
  const MapMessage good = message_;
  const auto refused = [&](const std::string& what) {
    EXPECT_NE(error().find(what), std::string::npos) << what << ": " << error();
    message_ = good;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  message_.frame = "odom";
  refused("map is in the frame 'odom', not in 'map'");
  for (const float bad : {0.0F, -0.05F, std::numeric_limits<float>::quiet_NaN(),
                          std::numeric_limits<float>::infinity()}) {
    message_.resolution_m = bad;
    refused("map has the resolution ");
  }
  message_.width = 0;
  refused("map has 0 × 2 cells");
  message_.width = 9000;
  refused("map has 9000 × 2 cells, and a map has 1 to 8192");
  message_.width = message_.height = 4'000'000'000U;
  refused("cells, and a map has 1 to 8192");
  message_.height = 3;
  refused("map has 3 × 3 cells and 6 values");
  message_.origin_m.y() = nan;
  refused("map has its origin at nan");
  message_.origin_m.x() = 1e8;
  refused("map has its origin at 100000000 m");
  message_.orientation = {0, 0, 0, 0};
  refused("map has an orientation of the length 0");
  message_.orientation = {0, 0, nan, 1};
  refused("map has an orientation of the length nan");
  message_.orientation = {0.1, 0, 0, std::sqrt(0.99)};
  refused("map is tilted");
  const std::vector<std::int8_t> bad{0, 0, 0, 0, 101, 0};
  message_.data = bad;
  refused("map has the value 101 in cell (1, 1)");
  EXPECT_EQ(error(), "");
}

}  // namespace
}  // namespace ergocast::ros2
