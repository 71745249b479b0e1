// SPDX-License-Identifier: BSD-3-Clause
// Walls from a robot's map: they are where the map's cells are, however it lies.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "core/motion/walls.h"
#include "tests/scenario/scenarios.h"
#include "tests/support/temp_folder.h"

namespace ergocast {
namespace {

using namespace test;

/// A map of 20 by 10 cells of 5 m, by default over the small scenario's domain. '#' is occupied,
/// '?' unknown.
struct RoomMap {
  std::vector<std::string> rows = std::vector<std::string>(10, std::string(20, '.'));
  std::string origin = "[0, 0, 0]";

  char& at(int x, int y) {
    return rows[static_cast<std::size_t>(9 - y)][static_cast<std::size_t>(x)];
  }
};

class MapWallsTest : public ::testing::Test {
 protected:
  Loaded load(const RoomMap& map, const std::string& more = "",
              const std::string& domain = "size_x_m: 100 size_y_m: 50") {
    std::string picture = "P2\n" + std::to_string(map.rows[0].size()) + " 10\n255\n";
    for (const std::string& row : map.rows) {
      for (const char c : row) picture += c == '#' ? "0 " : c == '?' ? "205 " : "254 ";
    }
    std::ofstream(folder_.path() / "room.pgm") << picture;
    std::ofstream(folder_.path() / "room.yaml")
        << "image: room.pgm\nresolution: 5\norigin: " << map.origin
        << "\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n";
    std::string text = small_with("size_x_m: 100 size_y_m: 50", domain);
    text += "world { speed_limit_mps: 1000 walls { file: \"room.yaml\" " + more + " } }\n";
    std::ofstream(folder_.path() / "mine.textproto") << text;
    return Scenario::load(folder_.path() / "mine.textproto");
  }
  Rings walls(const RoomMap& map, const std::string& more = "",
              const std::string& domain = "size_x_m: 100 size_y_m: 50") {
    return good(load(map, more, domain)).mission().walls;
  }
  /// Whether the middle of a cell of the unturned map is solid.
  static bool solid(const Rings& rings, double x, double y) {
    return solid_at(rings, {5 * x + 2.5, 5 * y + 2.5});
  }

  TempFolder folder_;
};

TEST_F(MapWallsTest, AreWhereTheOccupiedAndUnknownCellsAre) {
  RoomMap map;
  map.at(12, 4) = map.at(13, 4) = '#';
  map.at(14, 4) = '?';
  for (const bool unknown_free : {false, true}) {
    const Rings rings = walls(map, unknown_free ? "unknown_free: true" : "");
    for (int y = 0; y < 10; ++y) {
      for (int x = 0; x < 20; ++x) {
        const char cell = map.at(x, y);
        EXPECT_EQ(solid(rings, x, y), cell == '#' || (cell == '?' && !unknown_free))
            << x << ' ' << y;
      }
    }
  }
}

TEST_F(MapWallsTest, LieWhereOriginAndYawSay) {
  RoomMap map;
  map.at(12, 4) = '#';
  map.origin = "[100, 50, 3.141592653589793]";
  const Rings rings = walls(map);
  EXPECT_TRUE(solid(rings, 7, 5));
  EXPECT_FALSE(solid(rings, 12, 4));
}

TEST_F(MapWallsTest, UnknownSpaceOutsideTheMapIsSolidUnlessTheMapCoversTheDomain) {
  RoomMap map;
  map.at(12, 4) = '#';
  EXPECT_FALSE(solid(walls(map), -1, 3));
  map.origin = "[5, 5, 0]";
  const Rings rings = walls(map);
  EXPECT_TRUE(solid(rings, 0, 0));
  EXPECT_TRUE(solid(rings, 15, 0));
  EXPECT_FALSE(solid(rings, 1, 1));
  EXPECT_TRUE(solid(rings, 13, 5));
  EXPECT_FALSE(solid(walls(map, "unknown_free: true"), 0, 0));
}

TEST_F(MapWallsTest, ReachAcrossADomainThatIsFarLargerThanTheMap) {
  RoomMap map;
  map.at(12, 4) = '#';
  const Rings rings = walls(map, "", "origin_x_m: -20 origin_y_m: -30 size_x_m: 180 size_y_m: 140");
  for (const double x : {-19.0, 159.0}) {
    for (const double y : {-29.0, 20.0, 109.0})
      EXPECT_TRUE(solid_at(rings, {x, y})) << x << ' ' << y;
  }
  EXPECT_FALSE(solid(rings, 5, 5));
}

TEST_F(MapWallsTest, AreCutNearASmallerDomain) {
  RoomMap map;
  for (int x = 0; x < 20; ++x) map.at(x, 2) = '#';
  const Rings rings = walls(map, "", "origin_x_m: 5 origin_y_m: 15 size_x_m: 40 size_y_m: 30");
  EXPECT_TRUE(solid(rings, 4, 2));
  EXPECT_FALSE(solid(rings, 15, 2));
}

TEST_F(MapWallsTest, SmallPatchesOfUnknownAreFree) {
  RoomMap map;
  map.at(12, 4) = '#';
  map.at(5, 5) = map.at(6, 5) = '?';
  EXPECT_FALSE(solid(walls(map), 5, 5));
  map.at(7, 5) = map.at(5, 6) = map.at(6, 6) = '?';
  EXPECT_TRUE(solid(walls(map), 5, 5));
}

TEST_F(MapWallsTest, NamesStartsInUnknownSpace) {
  RoomMap map;
  map.at(12, 4) = '#';
  for (int y = 0; y < 10; ++y) map.at(2, y) = map.at(1, y) = '?';
  const Loaded result = load(map);
  ASSERT_FALSE(result);
  const std::string printed = joined(result.error());
  EXPECT_TRUE(has(printed, "agents.starts[0]: is in unknown space of "));
  EXPECT_TRUE(has(printed, "room.yaml"));
  EXPECT_TRUE(has(printed, "unknown_free: true in world.walls[0]"));
  EXPECT_EQ(std::count(printed.begin(), printed.end(), '\n'), 1) << printed;
  good(load(map, "unknown_free: true"));
  for (int y = 0; y < 10; ++y) map.at(2, y) = map.at(1, y) = '#';
  EXPECT_TRUE(has(joined(load(map).error()), "agents.starts[0]: is in a wall"));
}

TEST_F(MapWallsTest, NamesStartsOutsideTheMapAsUnknownSpace) {
  RoomMap map;
  map.origin = "[30, 0, 0]";
  const Loaded result = load(map);
  ASSERT_FALSE(result);
  EXPECT_TRUE(has(joined(result.error()), "agents.starts[0]: is in unknown space of "));
}

/// A room in the west of 10 columns, and one in the east of 9.
RoomMap two_rooms() {
  RoomMap map;
  for (int y = 0; y < 10; ++y) map.at(10, y) = '#';
  return map;
}

TEST_F(MapWallsTest, CloseThePartsThatTheLargestHasNoWayToAndListThem) {
  const Scenario scenario = good(load(two_rooms()));
  ASSERT_EQ(scenario.map_rooms().size(), 1U);
  const MapRooms& rooms = scenario.map_rooms().front();
  EXPECT_NEAR(rooms.free_m2, 95 * 50, 1e-6);
  ASSERT_EQ(rooms.rooms.size(), 2U);
  EXPECT_EQ(rooms.used, 0);
  EXPECT_NEAR(rooms.rooms[0].area_m2, 50 * 50, 50);
  EXPECT_NEAR(rooms.rooms[1].area_m2, 45 * 50, 50);
  EXPECT_LT(rooms.rooms[0].middle_m.x(), 50);
  double closed_m2 = 0;
  for (const Polygon& polygon : rooms.closed) closed_m2 += area_m2(polygon);
  EXPECT_NEAR(closed_m2, 45 * 50, 7 / 16.0 * 5 * 190) << "straightened by 7/16 of a cell";
  const Rings& rings = scenario.mission().walls;
  EXPECT_FALSE(solid(rings, 5, 5));
  EXPECT_TRUE(solid(rings, 15, 5));
}

TEST_F(MapWallsTest, KeepThePartOfTheFirstStart) {
  RoomMap map = two_rooms();
  for (int y = 0; y < 10; ++y) map.at(4, y) = '#';  // the start is at (10, 20) m
  const Scenario scenario = good(load(map));
  EXPECT_EQ(scenario.map_rooms().front().rooms.size(), 3U);
  EXPECT_EQ(scenario.map_rooms().front().used, 2);
  const Rings& rings = scenario.mission().walls;
  EXPECT_FALSE(solid(rings, 2, 5));
  EXPECT_TRUE(solid(rings, 7, 5));
  EXPECT_TRUE(solid(rings, 15, 5));
}

TEST_F(MapWallsTest, CountADoorOnlyIfBodiesFitThrough) {
  RoomMap map = two_rooms();
  map.at(10, 5) = '.';  // 5 m wide
  EXPECT_FALSE(solid(walls(map), 15, 5));
  std::ofstream(folder_.path() / "wide.textproto") << small_with(
      "agents {",
      "world { speed_limit_mps: 1000 wall_clearance_m: 2.6 walls { file: \"room.yaml\" } } "
      "agents {");
  const auto wide = Scenario::load(folder_.path() / "wide.textproto");
  EXPECT_TRUE(solid(good(wide).mission().walls, 15, 5));
}

TEST_F(MapWallsTest, MapsAreTargetsUniformOverTheirFreeCellsAndRefusedIfTurned) {
  RoomMap map;
  for (int x = 3; x < 9; ++x) map.at(x, 7) = '#';
  good(load(map));  // writes the files
  std::ofstream csv(folder_.path() / "same.csv");
  for (const std::string& row : map.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) csv << (i > 0 ? "," : "") << (row[i] == '.');
    csv << '\n';
  }
  csv.close();
  const auto with = [&](const std::string& file) {
    std::ofstream(folder_.path() / "target.textproto")
        << small_with("uniform_weight: 1", "maps { file: " + file + " }");
    return Scenario::load(folder_.path() / "target.textproto");
  };
  const Coefficients written =
      good(with("\"same.csv\" origin_x_m: 0 origin_y_m: 0 size_x_m: 100 size_y_m: 50"))
          .mission()
          .target_coefficients;
  const Scenario ours = good(with("\"room.yaml\""));
  EXPECT_TRUE(ours.mission().target_coefficients.isApprox(written, 1e-12));
  EXPECT_EQ(ours.map_files().size(), 2U);
  good(with("\"room.pgm\" origin_x_m: 0 origin_y_m: 0 size_x_m: 100 size_y_m: 50"));
  map.origin = "[0, 0, 0.1]";
  good(load(map));
  const Loaded turned = with("\"room.yaml\"");
  ASSERT_FALSE(turned);
  EXPECT_TRUE(has(joined(turned.error()), "lies turned by its yaw"));
}

TEST_F(MapWallsTest, ListsThePictureAmongTheFiles) {
  RoomMap map;
  map.at(12, 4) = '#';
  const auto files = good(load(map)).map_files();
  EXPECT_EQ(files, (std::vector<std::filesystem::path>{folder_.path() / "room.yaml",
                                                       folder_.path() / "room.pgm"}));
}

}  // namespace
}  // namespace ergocast
