// SPDX-License-Identifier: BSD-3-Clause
// The driver between a team and an autopilot, by a clock of the test's own.
#include "bridges/mavlink/driver.h"

#include <gtest/gtest.h>

#include "tests/support/team.h"

namespace ergocast::mavlink {
namespace {

using namespace test;

constexpr auto kPowerOn = 50s;

Mission mission_of(double command_hold_s = 0.25) {
  Mission mission = small_mission(2);
  mission.timing.pace = Pace::kRealtime;
  mission.timing.command_hold_s = command_hold_s;
  mission.speed_limit_mps = 5;
  return mission;
}

/// The driver of agent 1, whose vehicle is 300 m east and 500 m north of the origin and is allowed
/// to move. Positions arrive `delay` after they were measured.
class DrivenFlight {
 public:
  explicit DrivenFlight(const Mission& mission, Tick tick = 0) {
    announce(mission);
    VehicleOptions options;
    options.local_origin_m = Eigen::Vector3d(300, 500, 0);
    options.altitude_m = 20;
    driver.emplace(kRun, kWorldLife, 1, options);
    pass(4s);
    MissionPart part = mission_part(1, MissionState::kRunning, roster_of(2));
    part.header.tick = tick;
    give(*driver, part, now);
  }
  void hear(const Packet& packet) { driver->receive(Received{{1, 1}, packet}, now); }

  void pass(std::chrono::nanoseconds time) {
    for (const Instant end = now + time; now < end;) {
      now += 100ms;
      const auto ms = (now - at(kPowerOn)) / std::chrono::milliseconds(1);
      if (ms % 1000 == 0) {
        Heartbeat heartbeat;
        heartbeat.type = 2;
        heartbeat.autopilot = 12;
        heartbeat.base_mode = 128;
        heartbeat.custom_mode = 6 << 16;
        hear(heartbeat);
        hear(ExtendedSysState{0, 2});
      }
      LocalPositionNed place;
      place.time_boot_ms = static_cast<std::uint32_t>(ms - delay / std::chrono::milliseconds(1));
      place.z = -20;
      place.vx = north_mps;
      hear(place);
      turn();
    }
  }
  void turn() {
    Outbox out;
    std::vector<Packet> packets;
    driver->advance(now, out, packets);
    for (const WorldState& state : only<WorldState>(out)) states.push_back(state);
    for (const Packet& packet : packets) {
      if (const auto* setpoint = std::get_if<SetPositionTargetLocalNed>(&packet))
        east_mps = setpoint->vy;
      if (const auto* question = std::get_if<Timesync>(&packet)) {
        Timesync answer = *question;
        answer.tc1 = (now - at(kPowerOn)).count();
        hear(answer);
      }
    }
  }
  /// Agent 1 commands a velocity to the east for the newest tick.
  void command(double mps) {
    give(*driver, command_of(1, driver->tick(), {mps, 0, 0}), now);
    turn();
  }

  std::optional<Driver> driver;
  Instant now = at(kPowerOn);
  std::chrono::nanoseconds delay{0};
  std::vector<WorldState> states;
  double east_mps = -1;
  float north_mps = 0;  // as the autopilot reports it
};

TEST(MavlinkDriver, SendsItsPlaceEachTickAndObeysItsAgent) {
  DrivenFlight flight(mission_of());
  EXPECT_TRUE(flight.states.empty());
  flight.pass(1s);
  ASSERT_EQ(flight.states.size(), 1U) << "it listens for another driver before";
  const WorldState& state = flight.states.front();
  EXPECT_EQ(state.header.tick, 0);
  EXPECT_EQ(state.part, 1);
  EXPECT_EQ(state.parts, 2);
  ASSERT_EQ(state.vehicle_count, 1);
  EXPECT_EQ(state.vehicles[0].id, 1);
  EXPECT_EQ(state.vehicles[0].position_m, Eigen::Vector3d(300, 500, 0)) << "a plane has no height";
  EXPECT_EQ(state.vehicles[0].answered_tick, -1);
  flight.command(3);
  EXPECT_EQ(flight.east_mps, 3);
  flight.pass(100ms);
  EXPECT_EQ(flight.states.back().header.tick, 1);
  EXPECT_EQ(flight.states.back().vehicles[0].answered_tick, 0);
  flight.command(50);
  EXPECT_EQ(flight.east_mps, 5) << "the mission's speed limit";
}

BatteryStatus battery(int percent, std::uint8_t id = 0, std::uint8_t function = 0) {
  BatteryStatus status;
  status.battery_remaining = static_cast<std::int8_t>(percent);
  status.id = id;
  status.battery_function = function;
  return status;
}

SysStatus whole(int percent) {
  SysStatus status;
  status.battery_remaining = static_cast<std::int8_t>(percent);
  return status;
}

TEST(MavlinkDriver, SendsTheChargeThatItsAutopilotReports) {
  DrivenFlight flight(mission_of());
  flight.pass(2s);
  const auto charge_ppm = [&] { return flight.states.back().vehicles[0].charge_ppm; };
  EXPECT_EQ(charge_ppm(), kNoCharge);
  for (const auto& [percent, ppm] : {std::pair(55, 550'000), {0, 0}, {127, kWhole_ppm}, {-1, -1}}) {
    flight.hear(whole(percent));
    flight.pass(100ms);
    EXPECT_EQ(charge_ppm(), ppm) << percent;
  }
}

TEST(MavlinkDriver, SendsTheLeastChargeOfTheBatteriesByWhichItsVehicleMoves) {
  DrivenFlight flight(mission_of());
  flight.pass(2s);
  const auto percent_after = [&](const Packet& packet) {
    flight.hear(packet);
    flight.pass(100ms);
    return flight.states.back().vehicles[0].charge_ppm / 10'000;
  };
  BatteryStatus used = battery(-1);
  used.energy_consumed = 900;
  used.voltages = {4000, 4000, 4000, 65535, 65535, 65535, 65535, 65535, 65535, 65535};
  EXPECT_EQ(percent_after(whole(80)), 80);
  EXPECT_EQ(percent_after(used), 80) << "its charge is not known, whatever it has consumed";
  EXPECT_EQ(percent_after(battery(70)), 70) << "the message of one battery wins";
  EXPECT_EQ(percent_after(whole(60)), 70);
  EXPECT_EQ(percent_after(battery(50, 1, 2)), 50) << "the least of two";
  EXPECT_EQ(percent_after(battery(10, 2, 3)), 50) << "that of the avionics";
  EXPECT_EQ(percent_after(battery(10, 3, 4)), 50) << "that of the payload";
  EXPECT_EQ(percent_after(battery(127, 1)), 70);
  EXPECT_EQ(percent_after(battery(-1, 0)), 100) << "the first is not known any longer";
  EXPECT_EQ(percent_after(battery(-1, 1)), 60) << "SYS_STATUS again";
  EXPECT_EQ(percent_after(battery(40)), 40);
  flight.pass(9s);
  EXPECT_EQ(percent_after(Statustext{}), 40);
  flight.pass(1s);
  EXPECT_EQ(percent_after(Statustext{}), 60) << "BATTERY_STATUS comes no longer";
  EXPECT_EQ(percent_after(whole(-1)), 0) << "not known: −1 millionth";
  EXPECT_EQ(flight.states.back().vehicles[0].charge_ppm, kNoCharge);
}

TEST(MavlinkDriver, NamesOnlyCommandsThatHadArrivedWhenThePositionWasMeasured) {
  DrivenFlight flight(mission_of());
  flight.pass(2s);
  flight.delay = 250ms;
  flight.pass(300ms);
  flight.command(3);
  const Tick commanded = flight.driver->tick();
  const auto answered = [&] { return flight.states.back().vehicles[0].answered_tick; };
  flight.pass(200ms);
  EXPECT_EQ(answered(), -1) << "the position is older than the command";
  flight.pass(200ms);
  EXPECT_EQ(answered(), commanded);
}

TEST(MavlinkDriver, StandsWithoutCommandsAndAtTheEnd) {
  DrivenFlight flight(mission_of());
  flight.pass(1s);
  flight.command(3);
  flight.pass(200ms);
  EXPECT_EQ(flight.east_mps, 3) << "held for 0.25 s";
  flight.pass(200ms);
  EXPECT_EQ(flight.east_mps, 0);
  give(*flight.driver, command_of(1, flight.driver->tick() - 3, {3, 0, 0}), flight.now);
  flight.turn();
  EXPECT_EQ(flight.east_mps, 0) << "it comes too late";

  DrivenFlight last(mission_of(), 98);
  last.pass(1s);
  last.command(3);
  last.pass(100ms);
  last.command(3);
  EXPECT_EQ(last.east_mps, 3);
  last.pass(100ms);
  EXPECT_EQ(last.driver->tick(), 100);
  EXPECT_EQ(last.east_mps, 0) << "the mission has 100 ticks";
}

TEST(MavlinkDriver, StandsAtOnceAfterAStopAndTellsSoUntilItDoes) {
  DrivenFlight flight(mission_of());
  flight.pass(1s);
  flight.command(3);
  Stop stop;
  stop.header = {kRun, kOperator, 5, 1, 0};
  stop.now = true;
  stop.reason = "stopped at once";
  give(*flight.driver, stop, flight.now);
  const Tick before = flight.driver->tick();
  flight.turn();  // the clock stands
  EXPECT_EQ(flight.east_mps, 0);
  flight.north_mps = 1;
  flight.pass(3s);
  EXPECT_FALSE(flight.driver->finished()) << "it moves on";
  EXPECT_EQ(flight.driver->tick(), before + 31);
  EXPECT_EQ(flight.states.back().vehicles[0].velocity_mps.y(), 1);
  flight.north_mps = 0.1F;
  flight.states.clear();
  flight.pass(400ms);
  EXPECT_FALSE(flight.driver->finished()) << "these states may all be lost";
  flight.pass(600ms);
  EXPECT_TRUE(flight.states.back().vehicles[0].velocity_mps.isZero(0)) << "it stands in the wind";
  EXPECT_TRUE(flight.driver->finished());
  EXPECT_FALSE(flight.driver->failed());
}

TEST(MavlinkDriver, ObeysOnlyThePresentAgentOfItsVehicle) {
  DrivenFlight flight(mission_of());
  flight.pass(1s);
  Command stranger = command_of(1, 0, {3, 0, 0});
  stranger.header.incarnation = 99;
  give(*flight.driver, stranger, flight.now);
  give(*flight.driver, command_of(0, 0, {3, 0, 0}), flight.now);
  give(*flight.driver, command_of(1, 5, {3, 0, 0}), flight.now);  // of a future tick
  flight.pass(100ms);
  EXPECT_EQ(flight.east_mps, 0);
}

TEST(MavlinkDriver, KeepsItsVehicleOutOfWalls) {
  Mission mission = mission_of();
  mission.walls = Rings{Ring{{305, 400}, {310, 400}, {310, 600}, {305, 600}}};
  mission.wall_clearance_m = 4.8;
  DrivenFlight flight(mission);
  flight.pass(1s);
  flight.command(3);
  EXPECT_GT(flight.east_mps, 0);
  EXPECT_LT(flight.east_mps, 2.1) << "0.2 m are left for 0.1 s";
}

TEST(MavlinkDriver, UsesNoPositionThatIsOlderThanTheSeparationAssumes) {
  Mission mission = mission_of();
  mission.separation.distance_m = 30;
  mission.separation.lease_s = 3;
  mission.separation.response_s = 0.15;
  DrivenFlight flight(mission);
  flight.delay = 200ms;
  flight.pass(2s);
  ASSERT_FALSE(flight.states.empty()) << flight.driver->reason();
  flight.delay = 300ms;
  flight.pass(200ms);
  flight.states.clear();
  flight.pass(1s);
  EXPECT_TRUE(flight.states.empty()) << "a vehicle follows within 0.15 s, and a tick has 0.1 s";
  DrivenFlight alone(mission_of());
  alone.delay = 300ms;
  alone.pass(2s);
  EXPECT_FALSE(alone.states.empty());
}

TEST(MavlinkDriver, RefusesMissionsThatVehiclesCannotFollow) {
  const auto reason = [](const Mission& mission) {
    DrivenFlight flight(mission);
    EXPECT_TRUE(flight.driver->failed());
    return flight.driver->reason();
  };
  Mission mission = mission_of();
  mission.timing.pace = Pace::kLockstep;
  EXPECT_NE(reason(mission).find("lockstep"), std::string::npos);
  mission = mission_of();
  mission.timing.realtime_factor = 2;
  EXPECT_NE(reason(mission).find("realtime_factor"), std::string::npos);
  mission = mission_of();
  mission.separation.distance_m = 30;
  mission.separation.guard = true;
  EXPECT_NE(reason(mission).find("lease_s"), std::string::npos);
}

TEST(MavlinkDriver, EndsIfAnotherOneDrivesItsVehicle) {
  DrivenFlight flight(mission_of());
  WorldState other = world_state(3, {{1, 1, 0}});
  other.vehicles[0].id = 1;
  other.header.incarnation = 1;
  give(*flight.driver, other, flight.now);
  EXPECT_TRUE(flight.driver->failed());
  EXPECT_NE(flight.driver->reason().find("driven by another driver already"), std::string::npos);
}

}  // namespace
}  // namespace ergocast::mavlink
