// SPDX-License-Identifier: BSD-3-Clause
// What the driver orders an autopilot, and when it leaves it to the pilot.
#include "tests/bridges/mavlink/vehicle_flight.h"

namespace ergocast::mavlink {
namespace {

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

/// On the ground, in the driver's mode and armed by the driver; `landed_state` from then on.
Flight armed(std::uint8_t make = kPx4, std::uint8_t landed_state = 1) {
  Flight flight = parked(make);
  flight.heartbeat.custom_mode = make == kPx4 ? kOffboard : kGuided;
  flight.pass(6.5);
  flight.begin();
  flight.pass(1);
  EXPECT_EQ(flight.orders(400), 1) << flight.log;
  flight.answer(400, 0);
  flight.sent.clear();
  flight.heartbeat.base_mode = 128;
  flight.landed.landed_state = landed_state;
  flight.hear(flight.landed);
  flight.hear(flight.heartbeat);
  flight.pass(0.4);
  return flight;
}

TEST(MavlinkVehicle, IsThePilotsIfAnAcceptedOrderIsNotSeen) {
  for (const std::uint8_t make : {kPx4, kArduPilot}) {
    for (const std::uint16_t order : {176, 400}) {
      Flight flight = parked(make);
      if (order == 400) flight.heartbeat.custom_mode = make == kPx4 ? kOffboard : kGuided;
      flight.pass(6.5);
      flight.begin();
      flight.pass(1);
      ASSERT_EQ(flight.orders(order), 1) << flight.log;
      flight.answer(order, 0);
      flight.pass(30);
      EXPECT_EQ(flight.orders(), 1) << order << ": a pilot has disarmed it, or changed its mode";
      EXPECT_TRUE(flight.said("has taken over")) << flight.log;
    }
  }
  Flight flight = armed(kArduPilot);
  ASSERT_EQ(flight.orders(22), 1) << flight.log;
  flight.answer(22, 0);
  flight.pass(30);
  EXPECT_EQ(flight.orders(), 1) << "it does not take off again after a landing";
}

TEST(MavlinkVehicle, IsThePilotsIfItIsDisarmed) {
  Flight flight = armed();
  flight.heartbeat.base_mode = 0;
  flight.pass(10);
  EXPECT_EQ(flight.orders(), 0) << flight.log;
}

TEST(MavlinkVehicle, IsThePilotsIfItWasArmedBeforeTheDriverBegan) {
  for (const std::uint8_t make : {kPx4, kArduPilot}) {
    Flight flight = parked(make);
    flight.heartbeat.custom_mode = make == kPx4 ? kOffboard : kGuided;
    flight.heartbeat.base_mode = 128;
    flight.pass(6);
    flight.begin();
    flight.pass(10);
    EXPECT_EQ(flight.orders(), 0) << "the driver has begun anew, and somebody stands beside it";
    if (make == kPx4) EXPECT_TRUE(flight.stands());
    EXPECT_TRUE(flight.said("waits until the pilot has taken off")) << flight.log;
  }
}

TEST(MavlinkVehicle, IsThePilotsIfItIsArmedAfterTheDriverHasAskedInVain) {
  Flight flight = parked(kArduPilot);
  flight.heartbeat.custom_mode = kGuided;
  flight.pass(6);
  flight.begin();
  flight.pass(10);
  ASSERT_TRUE(flight.said("leaves it to the pilot")) << flight.log;
  flight.heartbeat.base_mode = 128;
  flight.pass(10);
  EXPECT_EQ(flight.orders(22), 0) << "the pilot has armed it, and stands beside it";
  flight.landed.landed_state = 2;
  flight.at.relative_alt = 20'000;
  flight.pass(1);
  EXPECT_TRUE(flight.follows()) << flight.log;
}

/// On the ground, in the driver's mode, asked to arm, and armed by the pilot before an answer.
Flight armed_by_the_pilot(std::uint8_t make) {
  Flight flight = parked(make);
  flight.heartbeat.custom_mode = make == kPx4 ? kOffboard : kGuided;
  flight.pass(6.5);
  flight.begin();
  flight.pass(1);
  EXPECT_EQ(flight.orders(400), 1) << flight.log;
  flight.heartbeat.base_mode = 128;
  return flight;
}

bool takes_off(const Flight& flight) { return flight.orders(22) > 0 || flight.setpoint().z() > 0; }

TEST(MavlinkVehicle, IsThePilotsIfItIsArmedAndNoOrderOfTheDriverWasAccepted) {
  for (const std::uint8_t make : {kPx4, kArduPilot}) {
    Flight flight = armed_by_the_pilot(make);
    for (int i = 0; i < 60; ++i) {
      flight.pass(0.1);
      ASSERT_FALSE(takes_off(flight)) << i << ": the pilot stands beside it";
    }
    flight.answer(400, 0);  // of an order that arrived after the pilot's
    flight.pass(3);
    EXPECT_FALSE(takes_off(flight)) << "the vehicle is the pilot's by then";

    Flight refused = armed_by_the_pilot(make);
    refused.answer(400, 1);
    refused.pass(1);
    refused.answer(400, 0);
    refused.pass(2);
    EXPECT_FALSE(takes_off(refused)) << "the driver's order was refused before";
  }
}

TEST(MavlinkVehicle, IsTheDriversIfTheAnswerIsOvertakenByAHeartbeat) {
  for (const std::uint8_t make : {kPx4, kArduPilot}) {
    Flight flight = armed_by_the_pilot(make);
    flight.pass(1);  // with a heartbeat that says it is armed
    EXPECT_FALSE(takes_off(flight));
    flight.answer(400, 0);
    flight.pass(1.1);
    EXPECT_TRUE(takes_off(flight)) << flight.log;
  }
}

/// It accepts the order to arm all the same.
TEST(MavlinkVehicle, IsThePilotsIfItWasArmedBeforeTheChecksThatComeWithTheOrder) {
  for (const std::uint8_t make : {kPx4, kArduPilot}) {
    Flight flight = armed_by_the_pilot(make);
    EXPECT_EQ(flight.orders(401), 1) << "before the order to arm";
    flight.checks = 1;
    flight.answer(400, 0);
    flight.pass(3);
    EXPECT_FALSE(takes_off(flight)) << "the pilot stands beside it";
    EXPECT_TRUE(flight.said("waits until the pilot has taken off")) << flight.log;

    Flight lost = armed_by_the_pilot(make);
    lost.checks.reset();
    lost.answer(400, 0);
    lost.pass(3);
    EXPECT_FALSE(takes_off(lost)) << "the checks were not answered";

    Flight own = armed_by_the_pilot(make);
    own.checks = 0;
    own.answer(400, 0);
    own.pass(3);
    EXPECT_TRUE(takes_off(own)) << own.log;
  }
}

TEST(MavlinkVehicle, IsOrderedToArmOnlyInAnswerToAHeartbeat) {
  Flight flight = parked(kArduPilot);
  flight.heartbeat.custom_mode = kGuided;
  flight.pass(6.5);
  flight.begin();
  flight.pass(0.4);
  EXPECT_EQ(flight.orders(400), 0) << "a pilot may have armed it since the last heartbeat";
  flight.pass(0.2);
  EXPECT_EQ(flight.orders(400), 1) << flight.log;
}

TEST(MavlinkVehicle, IsNotTakenFromAPilotOrAFailsafeWhileItIsArmed) {
  for (const int state : {1, 2, 3, 4}) {
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
  Flight flight = armed(kArduPilot, 3);
  flight.pass(5);
  EXPECT_EQ(flight.orders(22), 0) << "it takes off already";
  flight.landed.landed_state = 1;
  flight.pass(2);
  EXPECT_GT(flight.orders(22), 0);
}

/// A PX4 that takes off by climbing at 1 m/s.
Flight taking_off() {
  Flight flight = armed();
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

TEST(MavlinkVehicle, IgnoresAnswersToOtherStations) {
  Flight flight = parked();
  flight.pass(6.5);
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

}  // namespace
}  // namespace ergocast::mavlink
