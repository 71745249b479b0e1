// SPDX-License-Identifier: BSD-3-Clause
// When a vehicle follows its agent, and when it stands.
#include "tests/bridges/mavlink/vehicle_flight.h"

namespace ergocast::mavlink {
namespace {

TEST(MavlinkVehicle, FollowsItsAgentOnceItMayAndNoGapIsLongerThanATwentiethOfASecond) {
  Flight flight;
  flight.pass(4);
  EXPECT_TRUE(flight.stands());
  flight.begin();
  flight.sent.clear();
  flight.pass(10);
  EXPECT_TRUE(flight.follows()) << flight.log;
  EXPECT_GE(flight.sent_of<SetPositionTargetLocalNed>().size(), 199U);
  EXPECT_TRUE(flight.said("follows its agent"));
  EXPECT_TRUE(std::ranges::all_of(flight.sent_of<CommandLong>(), [](const CommandLong& command) {
    return command.command == 511 || command.command == 512;
  })) << "it asks for messages, and orders nothing";
}

TEST(MavlinkVehicle, IsToldAtOnceToStand) {
  Flight flight;
  flight.pass(4);
  flight.begin();
  flight.pass(1);
  flight.vehicle.fly({0, 0, 0});
  flight.turn();  // the clock stands
  EXPECT_TRUE(flight.stands());
}

TEST(MavlinkVehicle, StandsUntilThePilotHasArmedTakenOffAndChosenTheMode) {
  Flight flight;
  flight.heartbeat.custom_mode = kPosctl;
  flight.heartbeat.base_mode = 0;
  flight.landed.landed_state = 1;
  flight.pass(4);
  flight.begin();
  flight.pass(3);
  EXPECT_TRUE(flight.said("waits until the pilot chooses OFFBOARD (now POSCTL)"));
  flight.heartbeat.custom_mode = kOffboard;
  flight.pass(3);
  EXPECT_TRUE(flight.said("waits until the pilot arms"));
  flight.heartbeat.base_mode = 128;
  flight.pass(3);
  EXPECT_TRUE(flight.said("waits until the pilot has taken off"));
  EXPECT_TRUE(std::ranges::all_of(flight.sent_of<SetPositionTargetLocalNed>(), [](const auto& m) {
    return m.vx == 0 && m.vy == 0 && m.vz == 0;
  })) << "also upwards: it would take off";
  flight.landed.landed_state = 2;
  flight.pass(1);
  EXPECT_TRUE(flight.follows()) << flight.log;
}

TEST(MavlinkVehicle, IsThePilotsAtOnceAndFollowsAgainWhenItIsGivenBack) {
  for (const std::uint8_t make : {kPx4, kArduPilot}) {
    VehicleOptions with_command = options();
    with_command.take_command = true;
    Flight flight(with_command, make);
    flight.pass(4);
    flight.begin();
    flight.pass(1);
    ASSERT_TRUE(flight.follows());
    const std::uint32_t mode = flight.heartbeat.custom_mode;
    flight.heartbeat.custom_mode = make == kPx4 ? kPosctl : kLoiter;
    flight.hear(flight.heartbeat);
    flight.sent.clear();
    flight.pass(20);
    EXPECT_TRUE(flight.said("the pilot or a failsafe has taken over")) << flight.log;
    EXPECT_TRUE(flight.sent_of<CommandLong>().empty()) << "it does not fight for the vehicle";
    const auto setpoints = flight.sent_of<SetPositionTargetLocalNed>();
    EXPECT_EQ(setpoints.empty(), make == kArduPilot);
    EXPECT_TRUE(std::ranges::all_of(
        setpoints, [](const auto& m) { return m.vx == 0 && m.vy == 0 && m.vz == 0; }));
    flight.heartbeat.custom_mode = mode;
    flight.pass(1.5);
    EXPECT_TRUE(flight.follows()) << flight.log;
  }
}

TEST(MavlinkVehicle, HoldsTheHeightOfAPlaneAndIsCommandedUpAndDownInABox) {
  Flight flight;
  flight.at.relative_alt = 21000;
  flight.pass(4);
  flight.begin();
  flight.pass(1);
  EXPECT_TRUE(flight.setpoint().isApprox(Eigen::Vector3d(4, 3, -0.5))) << flight.setpoint();
  flight.at.relative_alt = 40000;
  flight.pass(1);
  EXPECT_TRUE(flight.setpoint().isApprox(Eigen::Vector3d(0, 0, -1))) << "down to its height first";
  Flight box;
  box.pass(4);
  box.begin(false);
  box.vehicle.fly({0, 0, 2});
  box.pass(1);
  EXPECT_EQ(box.setpoint(), Eigen::Vector3d(0, 0, 2));
  EXPECT_EQ(box.vehicle.fix(box.now)->position_m.z(), 20) << "above the origin, not above home";
}

TEST(MavlinkVehicle, StandsWhileTheLinkOrThePositionIsLost) {
  Flight flight;
  flight.pass(4);
  flight.begin();
  flight.pass(1);
  flight.positions = false;
  flight.pass(0.4);
  EXPECT_TRUE(flight.follows());
  flight.pass(0.3);
  EXPECT_TRUE(flight.stands());
  EXPECT_FALSE(flight.vehicle.fix(flight.now));
  EXPECT_TRUE(flight.said("older than 0.5 s"));
  flight.positions = true;
  flight.pass(0.2);
  EXPECT_TRUE(flight.follows());
  flight.beats = false;
  flight.pass(4.2);
  EXPECT_TRUE(flight.stands());
  EXPECT_TRUE(flight.said("the link is lost"));
  EXPECT_FALSE(flight.vehicle.fix(flight.now)) << "the others stand, too";
}

TEST(MavlinkVehicle, StandsFarOutsideOfTheDomain) {
  Flight flight;
  flight.at.lat -= 8000;  // 89 m south of the domain, which is 100 m long
  flight.pass(4);
  flight.begin();
  flight.pass(1);
  EXPECT_TRUE(flight.follows()) << flight.log;
  Flight lost;
  lost.at.lat -= 10000;
  lost.pass(4);
  lost.begin();
  lost.pass(1);
  EXPECT_TRUE(lost.stands());
  EXPECT_TRUE(lost.said("is far outside of the domain: is --origin that of the scenario?"));
  EXPECT_TRUE(lost.vehicle.fix(lost.now)) << "the others know where it is";
}

TEST(MavlinkVehicle, TellsOfItsBatteryEachTenth) {
  Flight flight;
  flight.pass(4);
  SysStatus status;
  for (const int left : {-1, 80, 51, 50, 49, 45, 40, 39, 12, 11, 10}) {
    status.battery_remaining = static_cast<std::int8_t>(left);
    flight.hear(status);
  }
  flight.log.clear();
  flight.turn();
  EXPECT_EQ(flight.log,
            "the battery has 50 %\nthe battery has 40 %\nthe battery has 12 %\n"
            "the battery has 10 %\n");
}

TEST(MavlinkVehicle, ThatIsNoMulticopterOrRoverOrHasAnotherAutopilotIsRefused) {
  const auto refused = [](std::uint8_t type, std::uint8_t autopilot) {
    Flight flight;
    flight.heartbeat.type = type;
    flight.heartbeat.autopilot = autopilot;
    flight.pass(5);
    EXPECT_TRUE(flight.sent_of<SetPositionTargetLocalNed>().empty());
    EXPECT_FALSE(flight.said("--system")) << "the reason is enough";
    return flight.vehicle.fatal();
  };
  EXPECT_NE(refused(1, kPx4).find("fixed wing, which cannot be stopped"), std::string::npos);
  EXPECT_NE(refused(20, kArduPilot).find("VTOL"), std::string::npos);
  EXPECT_NE(refused(7, kPx4).find("of type 7"), std::string::npos);
  EXPECT_NE(refused(2, 0).find("autopilot 0"), std::string::npos);
}

TEST(MavlinkVehicle, IsRefusedForAMissionThatItsOptionsDoNotFit) {
  const auto refused = [](std::optional<double> altitude_m, bool planar, std::uint8_t type) {
    VehicleOptions others = options();
    others.altitude_m = altitude_m;
    others.origin->has_altitude = false;
    Flight flight(others);
    flight.heartbeat.type = type;
    flight.pass(4);
    flight.begin(planar);
    flight.pass(1);
    return flight.vehicle.fatal();
  };
  EXPECT_NE(refused(std::nullopt, true, 2).find("--altitude"), std::string::npos);
  EXPECT_EQ(refused(std::nullopt, true, 10), "") << "a rover has no height";
  EXPECT_NE(refused(20, false, 10).find("a rover cannot climb"), std::string::npos);
  EXPECT_NE(refused(20, false, 2).find("--origin needs the altitude"), std::string::npos);
}

TEST(MavlinkVehicle, OfAnotherSystemIsNotDriven) {
  VehicleOptions third = options();
  third.system = 3;
  Flight flight(third);
  flight.pass(5);
  EXPECT_TRUE(flight.sent_of<SetPositionTargetLocalNed>().empty());
  EXPECT_TRUE(flight.said("system 1 is on this link, too, and not driven; waits for --system 3"))
      << flight.log;
  flight.hear(flight.heartbeat, {3, 1});
  EXPECT_EQ(flight.vehicle.source(), (Source{3, 191}));
}

TEST(MavlinkVehicle, HasOneDriver) {
  Heartbeat other;
  other.type = 18;
  other.autopilot = 8;
  other.custom_mode = 999;  // the smaller identity
  other.system_status = 3;
  Flight later;
  later.pass(1);
  other.custom_mode = 0;
  later.hear(other, {1, 191});
  EXPECT_EQ(later.vehicle.fatal(), "") << "another computer, which is no driver";
  other.custom_mode = 999;
  later.hear(other, {1, 191});
  EXPECT_EQ(later.vehicle.fatal(), "another driver is on this vehicle: end that one first");
  other.custom_mode = 1001;
  Flight first;
  first.pass(1);
  first.hear(other, {1, 191});
  EXPECT_EQ(first.vehicle.fatal(), "") << "the other one stops";
  other.system_status = 4;
  first.hear(other, {1, 191});
  EXPECT_NE(first.vehicle.fatal(), "") << "that one drives already";
  Flight driving;
  driving.pass(5);
  driving.hear(other, {1, 191});
  driving.turn();
  EXPECT_EQ(driving.vehicle.fatal(), "");
  EXPECT_TRUE(driving.said("another driver has come"));
  other.custom_mode = 999;
  other.system_status = 3;
  driving.hear(other, {1, 191});
  EXPECT_EQ(driving.vehicle.fatal(), "") << "that one has not begun";
  other.system_status = 4;
  driving.hear(other, {1, 191});
  EXPECT_NE(driving.vehicle.fatal(), "") << "both drive: the greater identity ends";
}

TEST(MavlinkVehicle, HoldsNoHeightWhileItMustNotMove) {
  const auto climbing = [](int lat = 0) {
    Flight flight;
    flight.at.relative_alt = 10'000;
    flight.at.lat += lat;
    flight.pass(4);
    flight.begin();
    flight.pass(1);
    return flight;
  };
  Flight flight = climbing();
  EXPECT_EQ(flight.setpoint(), Eigen::Vector3d(0, 0, 1)) << flight.log;
  flight.beats = false;
  flight.pass(4.2);
  EXPECT_TRUE(flight.said("the link is lost")) << flight.log;
  EXPECT_TRUE(flight.stands());
  EXPECT_TRUE(climbing(-10'000).stands()) << "it is at a wrong place";
}

TEST(MavlinkVehicle, IsInTheAirOnlyByANewMessageOfTheSameAutopilot) {
  for (const std::uint8_t make : {kPx4, kArduPilot}) {
    Flight flight(options(), make);
    flight.pass(4);
    flight.begin();
    flight.pass(1);
    ASSERT_TRUE(flight.follows());
    flight.knows_landed = false;
    flight.sent.clear();
    flight.pass(2.9);
    EXPECT_TRUE(flight.follows());
    flight.pass(1.5);
    EXPECT_TRUE(flight.stands());
    EXPECT_TRUE(flight.said("does not send EXTENDED_SYS_STATE")) << flight.log;
    EXPECT_GT(flight.orders(511), 0) << "it asks again";
    flight.hear(flight.landed);
    flight.pass(0.1);
    EXPECT_TRUE(flight.follows());
    ExtendedSysState undefined;
    flight.hear(undefined);
    flight.pass(0.1);
    EXPECT_TRUE(flight.stands()) << "MAV_LANDED_STATE_UNDEFINED";
  }
  Flight anew;
  anew.pass(5);
  anew.begin();
  anew.knows_landed = false;
  GlobalPositionInt restarted = anew.at;
  restarted.time_boot_ms = 0;
  anew.hear(restarted);
  anew.pass(1.5);
  EXPECT_TRUE(anew.vehicle.fix(anew.now));
  EXPECT_TRUE(anew.stands()) << anew.log;
  EXPECT_TRUE(anew.said("does not send EXTENDED_SYS_STATE")) << anew.log;
}

TEST(MavlinkVehicle, IsLeftInPeaceInGuidedBeforeTheMission) {
  Flight flight(options(), kArduPilot);
  flight.pass(6);
  EXPECT_TRUE(flight.sent_of<SetPositionTargetLocalNed>().empty()) << "it would brake a flight";
  flight.vehicle.finish();
  EXPECT_TRUE(flight.vehicle.done());
  flight.pass(1);
  EXPECT_TRUE(flight.sent_of<SetPositionTargetLocalNed>().empty());
}

TEST(MavlinkVehicle, StandsForASecondAtTheEnd) {
  Flight flight;
  flight.pass(4);
  flight.begin();
  flight.pass(1);
  flight.vehicle.finish();
  EXPECT_FALSE(flight.vehicle.done());
  flight.turn();
  EXPECT_TRUE(flight.stands());
  flight.pass(1);
  EXPECT_TRUE(flight.vehicle.done());
}

}  // namespace
}  // namespace ergocast::mavlink
