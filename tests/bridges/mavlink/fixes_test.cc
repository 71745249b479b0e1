// SPDX-License-Identifier: BSD-3-Clause
// Which positions of an autopilot are trusted.
#include <limits>

#include "tests/bridges/mavlink/vehicle_flight.h"

namespace ergocast::mavlink {
namespace {

TEST(MavlinkVehicle, StandsAfterAJumpUntilPositionsAreSteady) {
  Flight flight;
  flight.pass(4);
  flight.begin();
  flight.pass(1);
  flight.at.lat += 4500;  // 50 m
  flight.pass(0.1);
  EXPECT_TRUE(flight.stands());
  EXPECT_FALSE(flight.vehicle.fix(flight.now)) << "the others stand, too";
  EXPECT_TRUE(flight.said("the position jumped by 50 m")) << flight.log;
  flight.pass(2.8);
  EXPECT_TRUE(flight.stands());
  flight.pass(0.3);
  EXPECT_TRUE(flight.follows()) << flight.log;
}

TEST(MavlinkVehicle, IgnoresPositionsThatWereOvertakenAndForgetsThoseBeforeARestart) {
  Flight flight;
  flight.pass(5);
  const auto before = flight.vehicle.fix(flight.now);
  GlobalPositionInt old = flight.at;
  old.time_boot_ms -= 200;
  old.lat += 100;
  flight.hear(old);
  EXPECT_EQ(flight.vehicle.fix(flight.now)->position_m, before->position_m);
  flight.pass(5);
  GlobalPositionInt anew = flight.at;
  anew.time_boot_ms = 50;
  flight.hear(anew);
  EXPECT_FALSE(flight.vehicle.fix(flight.now));
  EXPECT_NE(flight.vehicle.why_not(flight.now).find("started anew"), std::string::npos);
}

TEST(MavlinkVehicle, TakesLocalPositionsOnlyWithAKnownOrigin) {
  Flight flight;
  flight.positions = false;
  flight.local = true;
  flight.near.x = 8;
  flight.near.z = -20;
  flight.pass(5);
  EXPECT_FALSE(flight.vehicle.fix(flight.now)) << "two vehicles would both be at 0";
  EXPECT_TRUE(flight.said("counts from the vehicle's own start")) << flight.log;
  GpsGlobalOrigin start;
  start.latitude = 476535000 + 450;  // 5 m north of the scenario's
  start.longitude = 91750000;
  start.altitude = 400000;
  flight.hear(start);
  flight.pass(0.2);
  ASSERT_TRUE(flight.vehicle.fix(flight.now)) << flight.log;
  EXPECT_NEAR(flight.vehicle.fix(flight.now)->position_m.y(), 13, 0.02);
  flight.positions = true;
  GlobalPositionInt somewhere = flight.at;
  flight.at.lat = flight.at.lon = 0;
  flight.pass(0.2);
  EXPECT_TRUE(flight.vehicle.fix(flight.now)) << "GPS knows no place yet";
  flight.at = somewhere;
  flight.pass(0.2);
  ASSERT_TRUE(flight.vehicle.fix(flight.now)) << "GPS counts from now on";
  EXPECT_NEAR(flight.vehicle.fix(flight.now)->position_m.y(), 0, 0.02);

  flight.at.lat = flight.at.lon = 0;
  flight.pass(0.1);
  EXPECT_FALSE(flight.vehicle.fix(flight.now)) << "GPS has lost it";

  VehicleOptions stated;
  stated.local_origin_m = Eigen::Vector3d(100, 200, 0);
  stated.altitude_m = 20;
  Flight indoors(stated);
  indoors.local = true;  // and GLOBAL_POSITION_INT, too
  indoors.near.x = 10;
  indoors.pass(5);
  ASSERT_TRUE(indoors.vehicle.fix(indoors.now)) << indoors.log;
  EXPECT_EQ(indoors.vehicle.fix(indoors.now)->position_m, Eigen::Vector3d(100, 210, 0));
  indoors.near.x = std::numeric_limits<float>::quiet_NaN();
  indoors.pass(0.1);
  EXPECT_FALSE(indoors.vehicle.fix(indoors.now));
  EXPECT_TRUE(indoors.said("is no number"));
}

TEST(MavlinkVehicle, ForgetsTheOriginOfItsLocalFrameAtARestart) {
  Flight flight;
  flight.positions = false;
  flight.local = true;
  GpsGlobalOrigin start;
  start.latitude = 476535000;
  start.longitude = 91750000;
  flight.pass(2);
  flight.hear(start);
  flight.pass(4);
  ASSERT_TRUE(flight.vehicle.fix(flight.now)) << flight.log;
  LocalPositionNed restarted = flight.near;
  restarted.time_boot_ms = 0;
  flight.hear(restarted);
  flight.sent.clear();
  flight.pass(5);
  EXPECT_FALSE(flight.vehicle.fix(flight.now)) << "its local frame may begin elsewhere now";
  EXPECT_GT(flight.orders(512), 0) << "it asks for the origin";
  flight.hear(start);
  flight.pass(5);
  EXPECT_TRUE(flight.vehicle.fix(flight.now)) << flight.log;
}

TEST(MavlinkVehicle, HasNoPositionOfTheFuture) {
  Flight flight;
  flight.pass(5);
  GlobalPositionInt early = flight.at;
  early.time_boot_ms += 1;
  flight.hear(early);
  EXPECT_TRUE(flight.vehicle.fix(flight.now)) << "clocks drift";
  early.time_boot_ms += 100;
  flight.hear(early);
  EXPECT_FALSE(flight.vehicle.fix(flight.now)) << "it would be young for too long";
  EXPECT_NE(flight.vehicle.why_not(flight.now).find("in the future"), std::string::npos);
}

TEST(MavlinkVehicle, HasNoPositionByAnImpossibleClock) {
  Flight flight;
  flight.answers = flight.positions = false;
  flight.pass(3);
  Timesync answer = flight.sent_of<Timesync>().back();
  answer.tc1 = std::numeric_limits<std::int64_t>::max();
  flight.hear(answer);
  flight.pass(0.5);
  flight.at.time_boot_ms = 10;
  flight.hear(flight.at);
  EXPECT_FALSE(flight.vehicle.fix(flight.now)) << "no number is as large as its age";
}

/// Such autopilots answer TIMESYNC by the calendar, which may be that of 1970, and time positions
/// from their start.
TEST(MavlinkVehicle, HasNoPositionIfTheAutopilotAnswersByAnotherClock) {
  constexpr double kCalendar_s = 1.79e9;
  for (const double ahead_s : {kCalendar_s, 1.0, -1.0}) {
    Flight flight;
    flight.answers = false;
    flight.pass(4);
    flight.begin();
    for (int i = 0; i < 10; ++i) {
      flight.pass(1);
      Timesync answer = flight.sent_of<Timesync>().back();
      answer.tc1 = (flight.now - flight.kPowerOn).count() + std::llround(ahead_s * 1e9);
      flight.hear(answer);
    }
    flight.pass(0.1);
    EXPECT_FALSE(flight.vehicle.fix(flight.now)) << ahead_s;
    EXPECT_TRUE(flight.stands());
    EXPECT_TRUE(flight.said(ahead_s > 0 ? "is older than" : "in the future")) << flight.log;
  }
}

TEST(MavlinkVehicle, HasNoPositionWithAPartThatIsNoNumber) {
  VehicleOptions indoors;
  indoors.altitude_m = 20;
  indoors.local_origin_m = Eigen::Vector3d(100, 210, 0);
  using Part = float LocalPositionNed::*;
  for (const Part part : {&LocalPositionNed::x, &LocalPositionNed::y, &LocalPositionNed::z,
                          &LocalPositionNed::vx, &LocalPositionNed::vy, &LocalPositionNed::vz}) {
    for (const float value :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
      Flight flight(indoors);
      flight.positions = false;
      flight.local = true;
      flight.near.z = -20;
      flight.pass(5);
      ASSERT_TRUE(flight.vehicle.fix(flight.now)) << flight.log;
      flight.begin();
      flight.near.*part = value;
      flight.pass(1);
      EXPECT_FALSE(flight.vehicle.fix(flight.now)) << value;
      EXPECT_TRUE(flight.stands());
      EXPECT_TRUE(flight.said("is no number")) << flight.log;
    }
  }
}

TEST(MavlinkVehicle, HasNoPositionWhoseAgeIsNotKnownAnyLonger) {
  Flight flight;
  flight.pass(5);
  flight.answers = false;
  flight.pass(15);
  EXPECT_TRUE(flight.vehicle.fix(flight.now));
  flight.pass(10);
  EXPECT_FALSE(flight.vehicle.fix(flight.now)) << "two clocks drift apart";
}

TEST(MavlinkVehicle, HasNoPositionWhoseAgeIsNotKnown) {
  Flight flight;
  flight.answers = false;
  flight.pass(5);
  EXPECT_FALSE(flight.vehicle.fix(flight.now));
  EXPECT_TRUE(flight.said("has not answered TIMESYNC"));
}

}  // namespace
}  // namespace ergocast::mavlink
