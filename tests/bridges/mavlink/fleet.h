// SPDX-License-Identifier: BSD-3-Clause
// A team whose vehicles are mock autopilots, in virtual time: the agents, the coordinator and the
// drivers of this process, the autopilots of another, and networks that lose, delay and repeat.
// Every message gets a delay of its own, so they overtake each other.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "agent/agent.h"
#include "bridges/mavlink/driver.h"
#include "bridges/mavlink/frame_reader.h"
#include "bridges/mavlink/frame_writer.h"
#include "coordinator/coordinator.h"
#include "tests/bridges/mavlink/mock_fleet.h"

namespace ergocast::mavlink {

/// A mission in real time over a square with a uniform target, with a driver for each of
/// `starts_m`.
inline Mission fleet_mission(double side_m, double speed_mps, double distance_m,
                             double position_error_m, std::vector<Eigen::Vector3d> starts_m) {
  Mission mission;
  mission.name = "fleet";
  mission.domain.size_m = {side_m, side_m, 0};
  mission.basis.modes_x = mission.basis.modes_y = 8;
  mission.target_coefficients = Coefficients::Zero(mission.basis.mode_count());
  mission.target_coefficients[0] = 1;
  mission.law.u_max_mps = mission.speed_limit_mps = speed_mps;
  mission.timing.dt_s = 0.1;
  mission.timing.tick_count = 1'000'000;
  mission.timing.pace = Pace::kRealtime;
  mission.timing.command_hold_s = 0.2;
  mission.timing.admission_timeout_s = 600;
  mission.separation.distance_m = distance_m;
  mission.separation.lease_s = 3;
  mission.separation.response_s = 0.5;
  mission.separation.position_error_m = position_error_m;
  mission.quorum = static_cast<int>(starts_m.size());
  mission.starts_m = std::move(starts_m);
  mission.wait_for_logger = false;
  return mission;
}

/// `across` × `across` places, the first at (first_m, first_m).
inline std::vector<Eigen::Vector3d> square_of_starts(int across, double first_m, double apart_m) {
  std::vector<Eigen::Vector3d> places_m;
  for (int i = 0; i < across * across; ++i)
    places_m.push_back({first_m + apart_m * (i % across), first_m + apart_m * (i / across), 0});
  return places_m;
}

/// Parts of a thousand.
struct Weather {
  unsigned lost = 50, repeated = 20;
  unsigned latest_ms = 60;
};

/// What is under way, by the time at which it arrives.
template <class T>
class Sky {
 public:
  Sky(const Weather& weather, std::mt19937_64& dice) : weather_(weather), dice_(dice) {}
  void send(Instant now, const T& what) {
    if (draw(1000) < weather_.lost) return;
    const int copies = draw(1000) < weather_.repeated ? 2 : 1;
    for (int i = 0; i < copies; ++i)
      all_.emplace(now + std::chrono::microseconds(draw(weather_.latest_ms * 1000)), what);
  }
  /// Calls `take(what)` for all that has arrived, in order.
  void arrive(Instant now, const auto& take) {
    while (!all_.empty() && all_.begin()->first <= now) {
      const T what = std::move(all_.begin()->second);
      all_.erase(all_.begin());
      take(what);
    }
  }

 private:
  unsigned draw(unsigned below) { return static_cast<unsigned>(dice_() % below); }
  const Weather& weather_;
  std::mt19937_64& dice_;
  std::multimap<Instant, T> all_;
};

class Fleet {
 public:
  /// Half of the vehicles have PX4, half ArduPilot. Each begins at its agent's start.
  /// @param node_mavlink  a folder with node_modules
  Fleet(const Mission& mission, const VehicleOptions& options, const std::string& node_mavlink,
        unsigned seed);

  /// Moves all vehicles by 20 ms, by the velocities that their autopilots want.
  using Bodies = std::function<std::vector<MockFleet::Body>(
      const std::vector<std::array<double, 3>>& wanted_mps)>;
  /// From now on the vehicles are bodies of another program.
  void set_bodies(Bodies bodies) { bodies_ = std::move(bodies); }

  void pass(double seconds);
  /// The pilot's order comes before the next step.
  void pilot(std::size_t vehicle, const std::string& order) {
    orders_.emplace_back(vehicle, order);
  }
  /// The driver's process is killed, and another one may begin.
  void kill_driver(std::size_t vehicle) { seats_[vehicle].driver.reset(); }
  void start_driver(std::size_t vehicle);
  std::string external_mode(std::size_t vehicle) const {
    return vehicle % 2 == 0 ? "OFFBOARD" : "GUIDED";
  }

  std::size_t size() const { return seats_.size(); }
  double now_s() const;
  const Coordinator& coordinator() const { return coordinator_; }
  /// At the end of the last pass().
  const nlohmann::json& state(std::size_t vehicle) const { return states_[vehicle]; }
  /// Where it really is, in the scenario's plane and above its home.
  Eigen::Vector3d place_m(std::size_t vehicle) const { return places_m_[vehicle]; }
  /// How far it has come in the plane since the last call.
  double way_m(std::size_t vehicle) { return std::exchange(seats_[vehicle].way_m, 0); }
  const std::string& log(std::size_t vehicle) const { return seats_[vehicle].log; }

  /// The least distance of two vehicles so far.
  double least_distance_m() const { return least_distance_m_; }
  /// The longest time between two setpoints that any vehicle has followed [s].
  double longest_gap_s() const;
  /// Setpoints that would have moved a vehicle though its driver knew that its pilot does not allow
  /// it.
  int disobeyed() const { return disobeyed_; }

 private:
  struct Sent {
    std::shared_ptr<const Message> message;
    Bus bus;
    AgentId transmitter;
    std::size_t to;  // agents, the coordinator, drivers
  };
  struct Frame {
    std::size_t vehicle;
    MockFleet::Bytes bytes;
  };
  struct Seat {
    std::unique_ptr<Agent> agent;
    std::unique_ptr<Driver> driver;
    std::unique_ptr<FrameWriter> writer;
    std::string log;
    bool ended = false;
    bool allowed = false;  // by the newest heartbeat that its driver has received
    double way_m = 0;
  };
  static constexpr std::chrono::milliseconds kTurn{5};

  void turn();
  void deliver(const Sent& sent);
  void take_frame(const Frame& frame);
  void advance();
  void publish(const Outbox& out);
  void send_packets(std::size_t vehicle, const std::vector<Packet>& packets);
  void step_vehicles();
  void take_places(const std::vector<std::array<double, 3>>& at);

  std::mt19937_64 dice_;
  Weather weather_;
  VehicleOptions options_;
  Instant now_{std::chrono::seconds(1000)}, end_ = now_;  // of pass()
  Coordinator coordinator_;
  std::vector<Seat> seats_;
  Incarnation next_identity_ = 500;
  Sky<Sent> team_;
  Sky<Frame> up_, down_;
  MockFleet mocks_;
  std::vector<std::pair<std::size_t, MockFleet::Bytes>> arrived_;
  std::vector<std::pair<std::size_t, std::string>> orders_;
  Bodies bodies_;
  std::vector<std::array<double, 3>> wanted_mps_;
  nlohmann::json states_;
  std::vector<Eigen::Vector3d> places_m_;
  double least_distance_m_ = 1e9;
  int disobeyed_ = 0;
};

}  // namespace ergocast::mavlink
