// SPDX-License-Identifier: BSD-3-Clause
#include "bridges/mavlink/places.h"

#include <gtest/gtest.h>

#include <cmath>

#include "target/geo/local_plane.h"

namespace ergocast::mavlink {
namespace {

// PROJ computes the plane of scenarios.
TEST(MavlinkPlaces, AreWhereScenariosHaveThemToAMillimetre) {
  for (const double latitude : {-78.5, -33.9, 0.0, 0.3, 47.6535, 71.2}) {
    const EarthPlace origin{latitude, 179.99, 400};
    const LocalPlane plane({latitude, 179.99});
    for (int i = 0; i < 48; ++i) {
      const double far_m = std::pow(10, i / 10.0), angle = 2.4 * i;
      const Eigen::Vector2d x_m(far_m * std::cos(angle), far_m * std::sin(angle));
      const GeoPlace there = plane.to_place(x_m);
      const auto found = local_m(origin, {there.latitude_deg, there.longitude_deg, 512.5});
      ASSERT_TRUE(found) << latitude << " " << i;
      EXPECT_NEAR(found->x(), x_m.x(), 1e-3) << latitude << " " << far_m;
      EXPECT_NEAR(found->y(), x_m.y(), 1e-3) << latitude << " " << far_m;
      EXPECT_EQ(found->z(), 112.5);
      const EarthPlace back = place_at(origin, x_m);
      EXPECT_NEAR(back.latitude_deg, there.latitude_deg, 1e-8) << latitude << " " << far_m;
      const double apart_deg = std::remainder(back.longitude_deg - there.longitude_deg, 360);
      EXPECT_NEAR(apart_deg * std::cos(there.latitude_deg * 0.0174533), 0, 1e-8) << far_m;
    }
  }
}

TEST(MavlinkPlaces, FarAwayOrOppositeAreRefused) {
  EXPECT_FALSE(local_m({47.65, 9.17, 0}, {0, 0, 0}));
  EXPECT_FALSE(local_m({47.65, 9.17, 0}, {-47.65, -170.83, 0}));
  EXPECT_TRUE(local_m({47.65, 9.17, 0}, {47.65, 9.17, 0})->isZero(0));
}

TEST(MavlinkPlaces, GoFromNorthEastDownToEastNorthUpAndBack) {
  GlobalPositionInt at;
  at.lat = 476535000;
  at.lon = 91750000;
  at.alt = 402500;
  at.vx = 100;
  at.vy = 200;
  at.vz = -300;
  EXPECT_TRUE(velocity_mps_of(at).isApprox(Eigen::Vector3d(2, 1, 3)));
  EXPECT_NEAR(place_of(at).latitude_deg, 47.6535, 1e-12);
  EXPECT_NEAR(place_of(at).altitude_m, 402.5, 1e-12);
  LocalPositionNed near;
  near.x = 10;
  near.y = 20;
  near.z = -30;
  EXPECT_EQ(offset_m_of(near), Eigen::Vector3d(20, 10, 30));
  const SetPositionTargetLocalNed setpoint = setpoint_of({2, 1, 3});
  EXPECT_EQ(setpoint.vx, 1);
  EXPECT_EQ(setpoint.vy, 2);
  EXPECT_EQ(setpoint.vz, -3);
  EXPECT_EQ(setpoint.type_mask, 0b110111000111) << "all but the velocity is ignored";
  EXPECT_EQ(setpoint.coordinate_frame, 1) << "MAV_FRAME_LOCAL_NED";
}

TEST(MavlinkPlaces, AreReadFromTextOrRefusedInASentence) {
  EXPECT_EQ(read_place("47.5,9,402")->altitude_m, 402);
  EXPECT_EQ(read_point("1.5,-2").value(), Eigen::Vector3d(1.5, -2, 0));
  for (const char* wrong : {"", "1", "1,", "91,0", "1,181", "1,2,3,4", "nan,0", "1;2", "1e999,2"})
    EXPECT_FALSE(read_place(wrong)) << wrong;
  EXPECT_NE(read_place("x").error().find("'x' is no place"), std::string::npos);
}

}  // namespace
}  // namespace ergocast::mavlink
