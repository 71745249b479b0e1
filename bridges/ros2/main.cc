// SPDX-License-Identifier: BSD-3-Clause
// ergocast-ros2: drives robots with ROS 2, and shows the team there.
#include <spdlog/spdlog.h>
#include <sys/epoll.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "bridges/ros2/dds_node.h"
#include "bridges/ros2/display_topics.h"
#include "bridges/ros2/driver.h"
#include "bridges/ros2/map_command.h"
#include "bridges/ros2/options.h"
#include "bridges/ros2/robot_topics.h"
#include "runtime/bus/clock.h"
#include "runtime/bus/random_identity.h"
#include "runtime/bus/transport.h"
#include "runtime/process/event_loop.h"
#include "runtime/process/logging.h"
#include "runtime/process/signals.h"

namespace ergocast::ros2 {
namespace {

using namespace std::chrono_literals;

/// The greatest time between two looks at what the display receives.
constexpr std::chrono::nanoseconds kShowTurn = 100ms;

Moment present() {
  const auto wall = std::chrono::system_clock::now().time_since_epoch();
  return {now(), std::chrono::duration_cast<std::chrono::nanoseconds>(wall).count()};
}

/// One descriptor that is readable when any of several is.
class AnyOf {
 public:
  explicit AnyOf(std::initializer_list<int> fds) : fd_(epoll_create1(EPOLL_CLOEXEC)) {
    for (const int fd : fds) {
      epoll_event event{};
      event.events = EPOLLIN;
      epoll_ctl(fd_, EPOLL_CTL_ADD, fd, &event);
    }
  }
  AnyOf(const AnyOf&) = delete;
  AnyOf& operator=(const AnyOf&) = delete;
  ~AnyOf() { close(fd_); }
  int fd() const { return fd_; }

 private:
  int fd_;
};

Robot make_robot(const BridgedRobot& robot) {
  return Robot(robot.limits, Positions(robot.topics.position, robot.frame, robot.base_frame,
                                       robot.limits.max_speed_mps));
}

/// The robots of the file, and the driver of their team.
class Drive {
 public:
  explicit Drive(const Options& options)
      : driver_(options.node.run, random_identity(), robots_of(options.bridge)) {}

  /// The exit code if it cannot begin.
  std::optional<int> open(const Options& options, DdsNode& node) {
    for (const BridgedRobot& robot : options.bridge.robots) {
      auto made = RobotConnection::make(node, robot);
      if (!made) return spdlog::error("{}", made.error()), kExitUnavailable;
      connections_.emplace(robot.id, *std::move(made));
    }
    examine();
    transport_ = connect(driver_, options.node);
    if (!transport_) return kExitUnavailable;
    return std::nullopt;
  }

  Driver& driver() { return driver_; }
  Transport& transport() { return *transport_; }

  /// Looks again whether topics connect as they must.
  void examine() {
    for (auto& [id, connection] : connections_) {
      if (const auto warning = connection.examine(driver_.robot(id)))
        spdlog::warn("robot {}: {}", id, *warning);
    }
  }

  void act() {
    const Moment at = present();
    for (auto& [id, connection] : connections_) connection.receive(driver_.robot(id), at);
    driver_.advance(at.now, out_);
    transport_->publish(out_);
    out_.clear();
    for (auto& [id, connection] : connections_) {
      Robot& robot = driver_.robot(id);
      if (const auto velocity = robot.due(at.now)) connection.send(*velocity, at.wall_ns);
      for (const Note& note : robot.take_notes())
        spdlog::log(note.warning ? spdlog::level::warn : spdlog::level::info, "robot {}: {}", id,
                    note.text);
    }
    transport_->set_run(driver_.run());
    if (const auto& mission = driver_.follower().mission())
      transport_->limit_agents(rate_budget_of(*mission, driver_.follower().roster().size()),
                               driver_.tick());
  }

  int report() const {
    spdlog::log(driver_.failed() ? spdlog::level::err : spdlog::level::info,
                "finished at tick {}: {}; {} commands too late", driver_.tick(), driver_.reason(),
                driver_.missed_deadlines());
    return driver_.failed() ? kExitFailed : kExitDone;
  }

 private:
  static std::map<AgentId, Robot> robots_of(const BridgeFile& bridge) {
    std::map<AgentId, Robot> robots;
    for (const BridgedRobot& robot : bridge.robots) robots.emplace(robot.id, make_robot(robot));
    return robots;
  }

  Driver driver_;
  std::map<AgentId, RobotConnection> connections_;
  std::unique_ptr<Transport> transport_;
  Outbox out_;
};

/// The team's displays.
class Show {
 public:
  explicit Show(const Options& options)
      : display_(options.node.run, now(), options.node.authenticator.keyed()) {}

  /// The exit code if it cannot begin.
  std::optional<int> open(const Options& options, DdsNode& node) {
    auto made = DisplayConnection::make(node, *options.bridge.display);
    if (!made) return spdlog::error("{}", made.error()), kExitUnavailable;
    connection_ = *std::move(made);
    transport_ = connect(display_, options.node);
    if (!transport_) return kExitUnavailable;
    return std::nullopt;
  }

  /// Reads the buses, waiting at most until `deadline` or for `wake_fd`.
  void act(Instant deadline, int wake_fd) {
    transport_->deliver_until(deadline, wake_fd);
    const Moment at = present();
    if (!display_.begun() || at.now < next_) return;
    next_ = at.now + kShowPeriod;
    connection_->show(display_, at);
    if (display_.over() && !over_since_) over_since_ = at.now;
  }
  /// Whether the mission's end has been shown.
  bool finished() const { return over_since_ && now() - *over_since_ > kLinger; }

 private:
  static constexpr auto kShowPeriod = 1s, kLinger = 2s;

  Display display_;
  std::optional<DisplayConnection> connection_;
  std::unique_ptr<Transport> transport_;
  Instant next_{};
  std::optional<Instant> over_since_;
};

int drive(const Options& options, DdsNode& node, Show* show, StopSignals& signals) {
  Drive drive(options);
  if (const auto code = drive.open(options, node)) return *code;
  spdlog::info("waits for a mission on {}, with {} robots in ROS domain {}",
               options.node.url.base(), options.bridge.robots.size(), options.domain_id);
  const AnyOf wakers{signals.fd(), node.fd()};
  for (drive.act(); !drive.driver().finished(); drive.act()) {
    const Instant before = now();
    const Instant latest = before + (show != nullptr ? kShowTurn : kLongestWait);
    const Instant planned = std::clamp(drive.driver().next_wakeup(), before, latest);
    drive.transport().deliver_until(planned, wakers.fd());
    if (signals.take() > 0) drive.driver().stop("a signal stopped the bridge");
    if (node.clear()) drive.examine();
    if (show != nullptr) show->act(now(), -1);
  }
  return drive.report();
}

int only_show(const Options& options, Show& show, StopSignals& signals) {
  spdlog::info("waits for a mission on {}, to show it in ROS domain {}", options.node.url.base(),
               options.domain_id);
  while (signals.take() == 0 && !show.finished()) show.act(now() + kShowTurn, signals.fd());
  return kExitDone;
}

int run(const Options& options) {
  StopSignals signals;
  const auto node = DdsNode::open(options.domain_id);
  if (!node) {
    spdlog::error("{}", node.error());
    return kExitUnavailable;
  }
  std::optional<Show> show;
  if (options.bridge.display) {
    show.emplace(options);
    if (const auto code = show->open(options, **node)) return *code;
  }
  if (options.bridge.robots.empty()) return only_show(options, *show, signals);
  return drive(options, **node, show ? &*show : nullptr, signals);
}

}  // namespace
}  // namespace ergocast::ros2

int main(int argc, char** argv) {
  using namespace ergocast;
  if (ros2::is_map_command(argc, argv)) return ros2::map_command(argc, argv);
  ros2::Options options;
  if (const int code = ros2::read_command_line(argc, argv, options); code >= 0) return code;
  set_up_logging("ros2", options.node.log_level);
  return ros2::run(options);
}
