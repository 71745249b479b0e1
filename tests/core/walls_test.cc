// SPDX-License-Identifier: BSD-3-Clause
// Walls: what is solid, how far it is, which rings are walls, and which places a way joins.
#include "core/motion/walls.h"

#include <gtest/gtest.h>

#include "core/motion/free_region.h"
#include "core/motion/starts.h"

namespace ergocast {
namespace {

Ring box(double x_m, double y_m, double width_m, double height_m) {
  return {{x_m, y_m}, {x_m + width_m, y_m}, {x_m + width_m, y_m + height_m}, {x_m, y_m + height_m}};
}

const Box kDomain{{0, 0, 0}, {100, 60, 0}};
/// A wall with a room in it, and in the room a block.
const Rings kNested = {box(10, 10, 40, 40), box(15, 15, 30, 30), box(25, 25, 10, 10)};

TEST(Walls, AreSolidWhereAnOddNumberOfRingsIsAround) {
  EXPECT_FALSE(solid_at(kNested, {5, 30}));
  EXPECT_TRUE(solid_at(kNested, {12, 30}));
  EXPECT_FALSE(solid_at(kNested, {20, 30}));
  EXPECT_TRUE(solid_at(kNested, {30, 30}));
}

TEST(Walls, AreAsFarAsTheirNearestEdge) {
  EXPECT_EQ(clearance_m(kNested, {5, 30}), 5);
  EXPECT_EQ(clearance_m(kNested, {7, 6}), 5);  // from a corner
  EXPECT_EQ(clearance_m(kNested, {12, 30}), -2);
  EXPECT_EQ(clearance_m(kNested, {17, 30}), 2);
  EXPECT_GT(clearance_m({}, {17, 30}), 1e300);
}

TEST(Walls, DoNotTouchAndStandInOrder) {
  EXPECT_TRUE(are_walls(kNested, kDomain));
  EXPECT_TRUE(are_walls({kNested[0], kNested[1], kNested[2], box(60, 0, 10, 10)}, kDomain));
  constexpr auto kInfinite = std::numeric_limits<double>::infinity();
  const Rings broken[] = {
      {kNested[1], kNested[0]},                      // a room before its wall
      {kNested[0], box(60, 0, 10, 10), kNested[1]},  // or after another wall
      {kNested[0], box(45, 45, 10, 10)},             // crosses
      {kNested[0], box(50, 10, 10, 10)},             // touches
      {{{0, 0}, {10, 10}, {10, 0}, {0, 10}}},        // crosses itself
      {{{0, 0}, {10, 10}}},                          // encloses nothing
      {{{0, 0}, {0, 0}, {10, 10}, {0, 10}}},         // a corner twice
      {{{0, 0}, {10, 10}, {5, 5 + 1e-9}}},           // almost no area
      {box(-1200, 0, 10, 10)},                       // far away
      {{{0, 0}, {10, 10}, {0, kInfinite}}},
      {{{0, 0}, {10, 10}, {0, std::nan("")}}},
      {{}},
      Rings(kMaxWallVertices / 4 + 1, box(1, 1, 2, 2)),
  };
  for (std::size_t i = 0; i < std::size(broken); ++i)
    EXPECT_FALSE(are_walls(broken[i], kDomain)) << i;
}

TEST(Walls, OfAsManyCornersAsAllowedAreWalls) {
  Rings many;
  for (int i = 0; i < kMaxWallVertices / 4; ++i)
    many.push_back(box(i % 64 * 1.5, i / 64 * 0.75, 0.5, 0.5));
  EXPECT_TRUE(are_walls(many, kDomain));
  many.push_back(box(97, 0, 0.5, 0.5));
  EXPECT_FALSE(are_walls(many, kDomain));
}

/// Thin triangles along a diagonal of the domain, side by side.
Rings grating(int count) {
  Rings rings;
  for (int i = 0; i < count; ++i) {
    const double x_m = i * 100.0 / count;
    rings.push_back({{x_m, 0}, {x_m + 100, 100}, {x_m + 100, 100 + 30.0 / count}});
  }
  return rings;
}

TEST(Walls, MayBeALargeGratingOnlyIfTheyHaveFewCorners) {
  EXPECT_TRUE(are_walls(grating(1024 / 3), kDomain));
  EXPECT_FALSE(are_walls(grating(kMaxWallVertices / 3), kDomain)) << "a plan would stall agents";
}

Mission walled() {
  Mission mission;
  mission.domain = kDomain;
  mission.walls = kNested;
  mission.wall_clearance_m = 2;
  mission.speed_limit_mps = 5;
  mission.seed = 7;
  return mission;
}

TEST(Walls, StopWhatIsPushedAgainstThem) {
  const Mission mission = walled();
  const double kept_m = kept_from_walls_m(mission, motion_of(mission, 0));
  EXPECT_GT(kept_m, 2);
  EXPECT_LT(kept_m, 2.001);
  const Eigen::Vector3d at_m(5, 30, 0), away_m(-3, 2, 0), toward_m(4, 1, 0), out_m(-10, 0, 0);
  EXPECT_EQ(stopped_by_walls(mission, 0, at_m, away_m), away_m);
  EXPECT_NEAR(stopped_by_walls(mission, 0, at_m, toward_m).x(), 5 - kept_m, 1e-9);
  EXPECT_NEAR(stopped_by_walls(mission, 0, at_m, out_m).x(), -5, 1e-9);
  EXPECT_EQ(stopped_by_walls(mission, 0, {8.5, 30, 0}, {1, 0, 0}).norm(), 0);
}

TEST(Walls, ABodyBeginsOutsideThem) {
  Mission mission = walled();
  for (AgentId id = 0; id < 300; ++id)
    EXPECT_GE(spare_at_start_m(mission, id, start_of(mission, id)), 0) << id;
  mission.walls = IndexedRings();
  int moved = 0;
  for (AgentId id = 0; id < 300; ++id)
    moved += spare_at_start_m(walled(), id, start_of(mission, id)) < 0 ? 1 : 0;
  EXPECT_GT(moved, 30) << "without walls some begin where those are";
}

TEST(Walls, AWingBeginsWithItsLoiterCircleOutside) {
  Mission mission = walled();
  mission.vehicle = {VehicleKind::kFixedWing, 0, 1, 3};
  const Motion motion = motion_of(mission, 0);
  const Eigen::Vector3d x_m(6, 30, 0);
  EXPECT_LT(spare_at_start_m(mission, 0, x_m), 0);
  mission.vehicle = {};
  EXPECT_GT(spare_at_start_m(mission, 0, x_m), 0);
  EXPECT_GT(kept_from_walls_m(mission, motion), 5);
}

/// Two rooms with a door of this width in the wall between them.
Rings rooms(double door_m) {
  return {box(48, -1, 4, 31 - door_m / 2), box(48, 30 + door_m / 2, 4, 40)};
}

TEST(FreeRegion, IsInTwoPartsWithoutADoorThatIsWideEnough) {
  for (const double kept_m : {1e-6, 2.0}) {
    const FreeRegion open(rooms(2 * kept_m + 1), kDomain, kept_m);
    EXPECT_EQ(open.parts(), 1) << kept_m;
    const FreeRegion closed(rooms(2 * kept_m - 1e-7), kDomain, kept_m);
    ASSERT_EQ(closed.parts(), 2) << kept_m;
    EXPECT_NEAR(closed.share_of(1), 0.5, 0.02);
    EXPECT_NE(closed.part_at({20, 30}), closed.part_at({80, 30}));
    EXPECT_EQ(closed.part_at({50, 10}), std::nullopt);
  }
}

TEST(FreeRegion, DoesNotLeapAThinWall) {
  const Rings thin = {box(50, -1, 1e-3, 62)};
  EXPECT_EQ(FreeRegion(thin, kDomain, 1e-6).parts(), 2);
}

// In the open, many ways along cells are equally short up to rounding.
TEST(FreeRegion, LeadsTheSameWayWhereverTheDomainIsAndWhateverItsAxesAreCalled) {
  const auto way_of = [](const Eigen::Vector2d& by_m, bool exchanged) {
    const auto place = [&](double x_m, double y_m) {
      return Eigen::Vector2d(by_m +
                             (exchanged ? Eigen::Vector2d(y_m, x_m) : Eigen::Vector2d(x_m, y_m)));
    };
    const Box domain{on_ground(by_m),
                     on_ground(exchanged ? Eigen::Vector2d(60, 100) : Eigen::Vector2d(100, 60))};
    const Rings walls = {{place(48, 20), place(52, 20), place(52, 61), place(48, 61)}};
    const FreeRegion region(walls, domain, 2);
    const auto ways_m = region.ways_m(region.cell_at(place(90.3, 50.1)));
    std::vector<Eigen::Vector2d> way;
    for (int cell = region.cell_at(place(7.7, 52.9)), last = -1; cell != last;
         last = cell, cell = region.nearer(ways_m, cell)) {
      const Eigen::Vector2d at_m = region.center_m(cell) - by_m;
      way.push_back(exchanged ? Eigen::Vector2d(at_m.y(), at_m.x()) : at_m);
    }
    return way;
  };
  const auto here = way_of({0, 0}, false);
  ASSERT_GT(here.size(), 200U);
  for (const Eigen::Vector2d& by_m :
       {Eigen::Vector2d(0, 0), {-15.6, 0.7}, {123.4, -1e4 / 3}, {0.1, 1e-3}}) {
    for (const bool exchanged : {false, true}) {
      const auto there = way_of(by_m, exchanged);
      ASSERT_EQ(there.size(), here.size()) << by_m.transpose() << exchanged;
      for (std::size_t i = 0; i < here.size(); ++i)
        ASSERT_LT((there[i] - here[i]).norm(), 1e-9) << by_m.transpose() << exchanged << i;
    }
  }
}

TEST(FreeRegion, HasAWayIfItIsNotLongerThanTheMost) {
  const FreeRegion region({box(50, 25, 0.5, 80)}, kDomain, 0.5);
  const int from = region.cell_at({45, 35}), to = region.cell_at({55, 35});
  const double way_m = region.ways_m(from)[static_cast<std::size_t>(to)];
  EXPECT_GT(way_m, 20);
  EXPECT_TRUE(region.has_way(from, to, 1.0001 * way_m));
  EXPECT_FALSE(region.has_way(from, to, 0.9999 * way_m));
  EXPECT_TRUE(region.has_way(from, from, 0));
}

TEST(FreeRegion, KnowsHowMuchIsFreeAndWhere) {
  const FreeRegion region(rooms(1), kDomain, 2);
  EXPECT_NEAR(region.free_share(), 0.92, 0.01);
  const Eigen::Vector2d middle_m = region.middle_m(0);
  EXPECT_EQ(region.part_at(middle_m), 0);
  EXPECT_GT(clearance_m(rooms(1), middle_m), 45);
}

}  // namespace
}  // namespace ergocast
