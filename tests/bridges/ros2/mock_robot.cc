// SPDX-License-Identifier: BSD-3-Clause
// A robot with cmd_vel and odom, and faults that a test orders by UDP: mock-robot PORT [options].
#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "tests/bridges/ros2/robot_port.h"

namespace ergocast::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kStep_ms = 10;
constexpr double kPositionPeriod_s = 0.02, kLongestStep_s = 0.1, kLag_s = 0.05;
/// It stops by itself if no command comes for so long, in steps of its own [s].
constexpr double kPatience_s = 30;

struct Faults {
  std::string frame, base;  // empty: the right ones
  bool no_number = false, silent = false;
  double jump_m = 0, clock_s = 0;
};

class Robot {
 public:
  Robot(const PortOptions& options, double x_m, double y_m)
      : options_(options), port_(make_port(options)), x_m_(x_m), y_m_(y_m) {}

  void step(double dt_s) {
    if (const auto twist = port_->take()) {
      command_ = *twist;
      ++commands_;
      since_command_s_ = 0;
    }
    since_command_s_ += dt_s;
    if (commands_ > 0 && since_command_s_ > kPatience_s) {
      ++timeouts_;
      since_command_s_ = 0;
      command_ = {};
    }
    for (std::size_t i = 0; i < 3; ++i)
      twist_[i] += (command_[i] - twist_[i]) * std::min(1.0, dt_s / kLag_s);
    const double cosine = std::cos(yaw_rad_), sine = std::sin(yaw_rad_);
    x_m_ += (cosine * twist_[0] - sine * twist_[1]) * dt_s;
    y_m_ += (sine * twist_[0] + cosine * twist_[1]) * dt_s;
    yaw_rad_ += twist_[2] * dt_s;
    path_m_ += std::hypot(twist_[0], twist_[1]) * dt_s;
    until_position_s_ -= dt_s;
    if (until_position_s_ > 0 || faults_.silent) return;
    until_position_s_ = kPositionPeriod_s;
    send();
  }

  /// Carries out an order, and returns the state.
  std::string order(const std::string& text) {
    std::istringstream words(text);
    std::string what;
    words >> what;
    if (what == "good") faults_ = {}, port_->set_second(false);
    if (what == "frame") words >> faults_.frame;
    if (what == "base") words >> faults_.base;
    if (what == "nan") faults_.no_number = true;
    if (what == "silent") faults_.silent = true;
    if (what == "jump") words >> faults_.jump_m;
    if (what == "clock") words >> faults_.clock_s;
    if (what == "second") port_->set_second(true);
    const nlohmann::json state = {{"order", text},
                                  {"x", x_m_},
                                  {"y", y_m_},
                                  {"path", path_m_},
                                  {"command", command_},
                                  {"commands", commands_},
                                  {"speed", std::hypot(twist_[0], twist_[1])},
                                  {"timeouts", timeouts_}};
    return state.dump();
  }

 private:
  void send() {
    PositionNumbers at;
    const auto wall = std::chrono::system_clock::now().time_since_epoch();
    at.stamp_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(wall).count() +
                  static_cast<std::int64_t>(faults_.clock_s * 1e9);
    at.frame = faults_.frame.empty() ? "map" : faults_.frame;
    at.base_frame = faults_.base.empty() ? options_.name + "/base_link" : faults_.base;
    at.x_m = faults_.no_number ? std::nan("") : x_m_ + faults_.jump_m;
    at.y_m = y_m_;
    at.yaw_rad = yaw_rad_;
    at.twist = twist_;
    port_->send(at);
  }

  PortOptions options_;
  std::unique_ptr<RobotPort> port_;
  Faults faults_;
  double x_m_, y_m_, yaw_rad_ = 0, path_m_ = 0;
  TwistNumbers command_{}, twist_{};
  int commands_ = 0, timeouts_ = 0;
  double since_command_s_ = 0, until_position_s_ = 0;
};

int listening_socket(int port) {
  const int fd = socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in at{AF_INET, htons(static_cast<in_port_t>(port)), {htonl(INADDR_LOOPBACK)}, {}};
  if (bind(fd, reinterpret_cast<const sockaddr*>(&at), sizeof at) != 0) std::exit(3);
  return fd;
}

/// Waits for an order at most a step, and answers it.
void answer(int fd, Robot& robot) {
  pollfd ready{fd, POLLIN, 0};
  if (poll(&ready, 1, kStep_ms) <= 0) return;
  char text[256];
  sockaddr_in from{};
  socklen_t size = sizeof from;
  const auto length = recvfrom(fd, text, sizeof text, 0, reinterpret_cast<sockaddr*>(&from), &size);
  if (length <= 0) return;
  const std::string state = robot.order({text, static_cast<std::size_t>(length)});
  sendto(fd, state.data(), state.size(), 0, reinterpret_cast<const sockaddr*>(&from), size);
}

int run(int port, const PortOptions& options, double x_m, double y_m) {
  Robot robot(options, x_m, y_m);
  const int fd = listening_socket(port);
  for (auto last = Clock::now();;) {
    answer(fd, robot);
    const auto now = Clock::now();
    robot.step(std::min(std::chrono::duration<double>(now - last).count(), kLongestStep_s));
    last = now;
  }
}

}  // namespace
}  // namespace ergocast::test

int main(int argc, char** argv) {
  ergocast::test::PortOptions options;
  double x_m = 0, y_m = 0;
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--name") options.name = argv[++i];
    if (word == "--at") x_m = std::atof(argv[++i]), y_m = std::atof(argv[++i]);
    if (word == "--topic") options.position_topic = argv[++i];
    if (word == "--stamped") options.stamped = true;
    if (word == "--pose") options.pose = true;
    if (word == "--latched-commands") options.latched_commands = true;
    if (word == "--best-effort") options.best_effort = true;
  }
  return ergocast::test::run(std::atoi(argv[1]), options, x_m, y_m);
}
