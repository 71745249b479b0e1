// SPDX-License-Identifier: BSD-3-Clause
// A vehicle and its autopilot, by a clock of the test's own.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bridges/mavlink/vehicle.h"

namespace ergocast::mavlink {

using namespace std::chrono_literals;

inline constexpr std::uint8_t kPx4 = 12, kArduPilot = 3;
inline constexpr std::uint32_t kOffboard = 6 << 16, kPosctl = 3 << 16, kGuided = 4, kLoiter = 5;

inline VehicleOptions options() {
  VehicleOptions options;
  options.origin = EarthPlace{47.6535, 9.175, 400};
  options.altitude_m = 20;
  return options;
}

/// A vehicle at 20 m above its home, with the messages that its autopilot sends: positions each
/// 0.05 s, a heartbeat each second. It executes no command.
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
    for (int i = 0; i < std::lround(seconds_passed * 20); ++i) {
      now += 50ms;
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
    if (command == 400 && checks) answer(401, *checks, to_system);
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
  std::optional<std::uint8_t> checks = 3;  // the answer to the checks before arming
  std::vector<Packet> sent;
  std::string log;
};

}  // namespace ergocast::mavlink
