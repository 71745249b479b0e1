// SPDX-License-Identifier: BSD-3-Clause
// What the driver sends to an autopilot, by a clock of the test's own.
#include "bridges/mavlink/vehicle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace ergocast::mavlink {
namespace {

using namespace std::chrono_literals;

constexpr std::uint8_t kPx4 = 12, kArduPilot = 3;
constexpr std::uint32_t kOffboard = 6 << 16, kPosctl = 3 << 16, kGuided = 4, kLoiter = 5;

VehicleOptions options() {
  VehicleOptions options;
  options.origin = EarthPlace{47.6535, 9.175, 400};
  options.altitude_m = 20;
  return options;
}

/// A vehicle at 20 m above its home, with the messages that its autopilot sends: positions each
/// 0.1 s, a heartbeat each second. It executes no command.
class Flight {
 public:
  explicit Flight(const VehicleOptions& options = mavlink::options(), std::uint8_t make = kPx4)
      : vehicle(options, 1000) {
    heartbeat.type = 2;
    heartbeat.autopilot = make;
    heartbeat.base_mode = 128;
    heartbeat.custom_mode = make == kPx4 ? kOffboard : kGuided;
    at.lat = 476535000;
    at.lon = 91750000;
    at.alt = 420000;
    at.relative_alt = 20000;
    landed.landed_state = 2;
  }

  void hear(const Packet& packet, Source from = {1, 1}) { vehicle.receive({from, packet}, now); }
  void pass(double seconds_passed) {
    for (int i = 0; i < std::lround(seconds_passed * 10); ++i) {
      now += 100ms;
      const auto ms = (now - kPowerOn) / std::chrono::milliseconds(1);
      at.time_boot_ms = near.time_boot_ms = static_cast<std::uint32_t>(ms);
      if (ms % 1000 == 0 && beats) hear(heartbeat);
      if (ms % 500 == 0 && knows_landed) hear(landed);
      if (positions) hear(at);
      if (local) hear(near);
      turn();
    }
  }
  void turn() {
    std::vector<Packet> out;
    vehicle.advance(now, out);
    for (const Packet& packet : out) {
      sent.push_back(packet);
      if (const auto* question = std::get_if<Timesync>(&packet); question && answers) {
        Timesync answer = *question;
        answer.tc1 = (now - kPowerOn).count();
        hear(answer);
      }
    }
    for (const Note& note : vehicle.take_notes()) log += note.text + "\n";
  }
  void begin(bool planar = true) {
    Box domain;
    domain.size_m = {100, 80, planar ? 0.0 : 100.0};
    vehicle.begin(domain, 5);
    vehicle.fly({3, 4, 0});
  }
  template <class M>
  std::vector<M> sent_of() const {
    std::vector<M> all;
    for (const Packet& packet : sent) {
      if (const auto* m = std::get_if<M>(&packet)) all.push_back(*m);
    }
    return all;
  }
  auto orders(std::uint16_t command) const {
    return std::ranges::count(sent_of<CommandLong>(), command, &CommandLong::command);
  }
  /// To choose the mode, to arm and to take off.
  auto orders() const { return orders(176) + orders(400) + orders(22); }
  /// The autopilot's answer to a command.
  void answer(std::uint16_t command, std::uint8_t result, std::uint8_t to_system = 0) {
    CommandAck ack;
    ack.command = command;
    ack.result = result;
    ack.target_system = to_system;
    hear(ack);
    turn();
  }
  /// North, east and up of the newest setpoint.
  Eigen::Vector3d setpoint() const {
    const auto all = sent_of<SetPositionTargetLocalNed>();
    if (all.empty()) return Eigen::Vector3d::Constant(-1);
    return {all.back().vx, all.back().vy, -all.back().vz};
  }
  bool stands() const { return setpoint().isZero(0); }
  bool follows() const { return setpoint() == Eigen::Vector3d(4, 3, 0); }
  bool said(const std::string& part) const { return log.find(part) != std::string::npos; }

  const Instant kPowerOn{100s};
  Vehicle vehicle;
  Instant now = kPowerOn;
  Heartbeat heartbeat;
  GlobalPositionInt at;
  LocalPositionNed near;
  ExtendedSysState landed;
  bool beats = true, positions = true, local = false, answers = true, knows_landed = true;
  std::vector<Packet> sent;
  std::string log;
};

TEST(MavlinkVehicle, FollowsItsAgentOnceItMayAndNoGapIsLongerThanATenthOfASecond) {
  Flight flight;
  flight.pass(4);
  EXPECT_TRUE(flight.stands());
  flight.begin();
  flight.sent.clear();
  flight.pass(10);
  EXPECT_TRUE(flight.follows()) << flight.log;
  EXPECT_GE(flight.sent_of<SetPositionTargetLocalNed>().size(), 99U);
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
}

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
  flight.near.x = 10;
  flight.near.z = -20;
  flight.pass(5);
  EXPECT_FALSE(flight.vehicle.fix(flight.now)) << "two vehicles would both be at 0";
  EXPECT_TRUE(flight.said("counts from the vehicle's own start")) << flight.log;
  GpsGlobalOrigin start;
  start.latitude = 476535000 + 900;  // 10 m north of the scenario's
  start.longitude = 91750000;
  start.altitude = 400000;
  flight.hear(start);
  flight.pass(0.2);
  ASSERT_TRUE(flight.vehicle.fix(flight.now)) << flight.log;
  EXPECT_NEAR(flight.vehicle.fix(flight.now)->position_m.y(), 20, 0.02);
  flight.positions = true;
  flight.pass(0.2);
  ASSERT_TRUE(flight.vehicle.fix(flight.now)) << "GPS counts from now on";
  EXPECT_NEAR(flight.vehicle.fix(flight.now)->position_m.y(), 0, 0.02);

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

TEST(MavlinkVehicle, HasNoPositionWhoseAgeIsNotKnown) {
  Flight flight;
  flight.answers = false;
  flight.pass(5);
  EXPECT_FALSE(flight.vehicle.fix(flight.now));
  EXPECT_TRUE(flight.said("has not answered TIMESYNC"));
}

TEST(MavlinkVehicle, ThatIsNoMulticopterOrRoverOrHasAnotherAutopilotIsRefused) {
  const auto refused = [](std::uint8_t type, std::uint8_t autopilot) {
    Flight flight;
    flight.heartbeat.type = type;
    flight.heartbeat.autopilot = autopilot;
    flight.pass(5);
    EXPECT_TRUE(flight.sent_of<SetPositionTargetLocalNed>().empty());
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
}

TEST(MavlinkVehicle, OrdersNothingUnlessToldTo) {
  Flight flight;
  flight.heartbeat.custom_mode = kPosctl;
  flight.heartbeat.base_mode = 0;
  flight.pass(4);
  flight.begin();
  flight.pass(20);
  for (const CommandLong& command : flight.sent_of<CommandLong>())
    EXPECT_TRUE(command.command == 511 || command.command == 512) << command.command;
}

TEST(MavlinkVehicle, TakesCommandOnlyIfToldToAndLeavesItToThePilotIfItIsRefused) {
  VehicleOptions with_command = options();
  with_command.take_command = true;
  Flight flight(with_command);
  flight.heartbeat.custom_mode = kPosctl;
  flight.heartbeat.base_mode = 0;
  flight.landed.landed_state = 1;
  flight.at.relative_alt = 0;
  flight.pass(6);
  EXPECT_EQ(flight.orders(), 0) << "the mission does not run yet";
  flight.begin();
  flight.pass(20);
  EXPECT_EQ(flight.orders(176), 5);
  flight.answer(176, 2);
  EXPECT_TRUE(flight.said("the autopilot refuses OFFBOARD: DENIED")) << flight.log;
  EXPECT_TRUE(flight.said("leaves it to the pilot"));
  flight.heartbeat.custom_mode = kOffboard;
  flight.pass(1.5);
  EXPECT_EQ(flight.orders(400), 1);
  flight.answer(400, 0);
  flight.heartbeat.base_mode = 128;
  flight.pass(2);
  EXPECT_EQ(flight.setpoint(), Eigen::Vector3d(0, 0, 1)) << "PX4 takes off by climbing";
}

/// On the ground and disarmed, outside of the driver's mode.
Flight parked(std::uint8_t make = kPx4) {
  VehicleOptions with_command = options();
  with_command.take_command = true;
  Flight flight(with_command, make);
  flight.heartbeat.custom_mode = make == kPx4 ? kPosctl : kLoiter;
  flight.heartbeat.base_mode = 0;
  flight.landed.landed_state = 1;
  flight.at.relative_alt = 0;
  return flight;
}

TEST(MavlinkVehicle, IsThePilotsIfAnAcceptedOrderIsNotSeen) {
  for (const std::uint8_t make : {kPx4, kArduPilot}) {
    for (const std::uint16_t order : {176, 400, 22}) {
      if (order == 22 && make == kPx4) continue;
      Flight flight = parked(make);
      if (order != 176) flight.heartbeat.custom_mode = make == kPx4 ? kOffboard : kGuided;
      if (order == 22) flight.heartbeat.base_mode = 128;
      flight.pass(6);
      flight.begin();
      flight.pass(1);
      ASSERT_EQ(flight.orders(order), 1) << flight.log;
      flight.answer(order, 0);
      flight.pass(30);
      EXPECT_EQ(flight.orders(), 1) << order << ": a pilot has disarmed it, or changed its mode";
      if (order != 22) EXPECT_TRUE(flight.said("has taken over")) << flight.log;
    }
  }
}

TEST(MavlinkVehicle, IsThePilotsIfItIsDisarmedInAnyMode) {
  Flight flight = parked();
  flight.heartbeat.base_mode = 128;
  flight.pass(6);
  flight.begin();
  flight.pass(1);
  EXPECT_EQ(flight.orders(176), 1) << "it is on the ground";
  flight.heartbeat.base_mode = 0;
  flight.hear(flight.heartbeat);
  flight.sent.clear();
  flight.pass(2);
  flight.heartbeat.custom_mode = kOffboard;
  flight.pass(10);
  EXPECT_EQ(flight.orders(), 0) << flight.log;
}

TEST(MavlinkVehicle, IsNotTakenFromAPilotOrAFailsafeWhileItFlies) {
  for (const int state : {2, 3, 4}) {
    Flight flight = parked();
    flight.heartbeat.base_mode = 128;
    flight.landed.landed_state = static_cast<std::uint8_t>(state);
    flight.pass(6);
    flight.begin();
    flight.pass(10);
    EXPECT_EQ(flight.orders(), 0) << "the driver has begun anew during a return";
    EXPECT_TRUE(flight.said("has taken over (POSCTL)")) << flight.log;
    flight.landed.landed_state = 1;
    flight.heartbeat.base_mode = 0;
    flight.pass(10);
    EXPECT_EQ(flight.orders(), 0) << "it has landed";
  }
  Flight rover = parked(kArduPilot);
  rover.heartbeat.type = 10;
  rover.heartbeat.base_mode = 128;
  rover.knows_landed = false;
  rover.pass(6);
  rover.begin();
  rover.pass(10);
  EXPECT_EQ(rover.orders(), 0) << rover.log;
}

TEST(MavlinkVehicle, IsOrderedToTakeOffOnlyOnTheGround) {
  Flight flight = parked(kArduPilot);
  flight.heartbeat.custom_mode = kGuided;
  flight.heartbeat.base_mode = 128;
  flight.landed.landed_state = 3;
  flight.pass(6);
  flight.begin();
  flight.pass(5);
  EXPECT_EQ(flight.orders(22), 0) << "it takes off already";
  flight.landed.landed_state = 1;
  flight.pass(2);
  EXPECT_GT(flight.orders(22), 0);
}

/// A PX4 that takes off by climbing at 1 m/s.
Flight taking_off() {
  Flight flight = parked();
  flight.heartbeat.custom_mode = kOffboard;
  flight.heartbeat.base_mode = 128;
  flight.pass(6);
  flight.begin();
  flight.pass(1);
  EXPECT_EQ(flight.setpoint(), Eigen::Vector3d(0, 0, 1)) << flight.log;
  return flight;
}

TEST(MavlinkVehicle, TakesOffNoHigherThanItsHeightAndOnlyWithALinkAndNoPilot) {
  Flight high = taking_off();
  high.at.relative_alt = 20'500;
  high.pass(0.2);
  EXPECT_TRUE(high.stands()) << "the autopilot has not noticed that it is in the air";
  Flight lost = taking_off();
  lost.beats = false;
  lost.pass(4.2);
  EXPECT_TRUE(lost.stands());
  Flight piloted = taking_off();
  piloted.heartbeat.base_mode = 0;
  piloted.hear(piloted.heartbeat);
  piloted.heartbeat.base_mode = 128;
  piloted.pass(3);
  EXPECT_TRUE(piloted.stands()) << "the pilot has disarmed and armed it";
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

TEST(MavlinkVehicle, IgnoresAnswersToOtherStations) {
  Flight flight = parked();
  flight.pass(6);
  flight.begin();
  flight.pass(1);
  flight.answer(176, 2, 255);
  EXPECT_FALSE(flight.said("refuses")) << flight.log;
  flight.answer(176, 0, 255);
  flight.pass(2);
  EXPECT_GT(flight.orders(176), 1) << "a ground station's order was accepted, and not its own";
  flight.answer(176, 2, 1);
  EXPECT_TRUE(flight.said("refuses")) << flight.log;
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
