// SPDX-License-Identifier: BSD-3-Clause
// Differential-drive robots in MuJoCo, each with its cmd_vel and odom: mujoco-robots PORT SCENARIO.
// A test asks for their state by UDP.
//
// The engine follows the clock. On a machine that is too slow it falls behind, and the robots move
// more slowly. A robot that gets no command for kPatience_s of the engine's time stops.
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "examples/mujoco/mujoco_physics.h"
#include "scenario/scenario.h"
#include "tests/bridges/ros2/robot_port.h"

namespace ergocast::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double kStep_s = 0.01, kPatience_s = 0.3;
constexpr int kMostSteps = 10, kStepsPerPosition = 2;

class RosDisc {
 public:
  RosDisc(AgentId id, mujoco::MujocoPhysics& physics)
      : id_(id), name_("robot" + std::to_string(id)), physics_(physics) {
    port_ = make_port({.name = name_});
    physics_.roll(id_, 0, 0);
  }

  void take_command() {
    if (const auto twist = port_->take()) {
      ++commands_;
      silent_s_ = 0;
      physics_.roll(id_, (*twist)[0], (*twist)[2]);
    } else if ((silent_s_ += kStep_s) > kPatience_s) {
      physics_.roll(id_, 0, 0);
    }
  }
  void note(const PhysicalBody& body) {
    speed_mps_ = body.velocity_mps.norm();
    path_m_ += speed_mps_ * kStep_s;
  }
  void send_position() {
    const mujoco::RobotState state = physics_.state(id_);
    const auto wall = std::chrono::system_clock::now().time_since_epoch();
    PositionNumbers at;
    at.stamp_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(wall).count();
    at.frame = "map";
    at.base_frame = name_ + "/base_link";
    at.x_m = state.position_m.x();
    at.y_m = state.position_m.y();
    at.yaw_rad = std::atan2(state.attitude(1, 0), state.attitude(0, 0));
    const Eigen::Vector3d own_mps = state.attitude.transpose() * state.velocity_mps;
    at.twist = {own_mps.x(), own_mps.y(), state.turning_radps.z()};
    port_->send(at);
  }
  nlohmann::json state() const {
    return {{"commands", commands_}, {"path", path_m_}, {"speed", speed_mps_}};
  }

 private:
  AgentId id_;
  std::string name_;
  mujoco::MujocoPhysics& physics_;
  std::unique_ptr<RobotPort> port_;
  int commands_ = 0;
  double silent_s_ = 0, path_m_ = 0, speed_mps_ = 0;
};

class Room {
 public:
  explicit Room(Mission mission) : physics_(with_steps(std::move(mission)), mujoco::kDiscs) {}

  void place(const std::vector<Eigen::Vector3d>& starts_m) {
    for (const Eigen::Vector3d& start_m : starts_m) {
      const auto id = static_cast<AgentId>(bodies_.size());
      physics_.place(id, start_m, {0, 0, 0});
      bodies_.push_back({id});
      robots_.push_back(std::make_unique<RosDisc>(id, physics_));
    }
  }

  void step() {
    for (auto& robot : robots_) robot->take_command();
    physics_.pass_tick(bodies_);
    for (std::size_t i = 0; i < robots_.size(); ++i) robots_[i]->note(bodies_[i]);
    if (++steps_ % kStepsPerPosition != 0) return;
    for (auto& robot : robots_) robot->send_position();
  }

  std::string state(const std::string& order) const {
    nlohmann::json state = {{"order", order},
                            {"robot_contacts", physics_.contacts().robots},
                            {"wall_contacts", physics_.contacts().walls},
                            {"robots", nlohmann::json::array()}};
    for (const auto& robot : robots_) state["robots"].push_back(robot->state());
    return state.dump();
  }

 private:
  static Mission with_steps(Mission mission) {
    mission.timing.dt_s = kStep_s;
    return mission;
  }

  mujoco::MujocoPhysics physics_;
  std::vector<PhysicalBody> bodies_;
  std::vector<std::unique_ptr<RosDisc>> robots_;
  int steps_ = 0;
};

int listening_socket(int port) {
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in at{AF_INET, htons(static_cast<in_port_t>(port)), {htonl(INADDR_LOOPBACK)}, {}};
  if (bind(fd, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0) std::exit(3);
  return fd;
}

/// Waits a little for a question about the state, and answers it.
void answer(int fd, const Room& room) {
  pollfd ready{fd, POLLIN, 0};
  if (poll(&ready, 1, static_cast<int>(kStep_s * 1000)) <= 0) return;
  char text[256];
  sockaddr_in from{};
  socklen_t size = sizeof from;
  const auto length = recvfrom(fd, text, sizeof text, 0, reinterpret_cast<sockaddr*>(&from), &size);
  if (length <= 0) return;
  const std::string state = room.state({text, static_cast<std::size_t>(length)});
  sendto(fd, state.data(), state.size(), 0, reinterpret_cast<const sockaddr*>(&from), size);
}

int run(int port, const char* file) {
  const auto scenario = Scenario::load(file, {});
  if (!scenario) {
    std::fprintf(stderr, "%s is no scenario\n", file);
    return 2;
  }
  const Mission mission = scenario->mission();
  Room room(mission);
  room.place(mission.starts_m);
  const int fd = listening_socket(port);
  for (auto due = Clock::now();;) {
    answer(fd, room);
    const auto now = Clock::now();
    const std::chrono::duration<double> behind = now - due;
    const int steps = std::min(static_cast<int>(behind.count() / kStep_s), kMostSteps);
    for (int i = 0; i < steps; ++i) room.step();
    due = steps == kMostSteps ? now : due + steps * std::chrono::milliseconds(10);
  }
}

}  // namespace
}  // namespace ergocast::test

int main(int argc, char** argv) {
  return argc == 3 ? ergocast::test::run(std::atoi(argv[1]), argv[2]) : 2;
}
