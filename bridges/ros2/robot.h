// SPDX-License-Identifier: BSD-3-Clause
// One robot: whether it may follow its agent, and the velocity that it is sent. No clock, no I/O.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bridges/ros2/positions.h"
#include "bridges/ros2/steering.h"
#include "core/base/geometry.h"

namespace ergocast::ros2 {

/// A line for the log.
struct Note {
  bool warning = false;
  std::string text;
};

/// A robot that is slower stands [m/s].
inline constexpr double kStanding_mps = 0.02;

class Robot {
 public:
  Robot(DriveLimits limits, Positions positions)
      : limits_(limits), positions_(std::move(positions)) {}

  void take(const PoseMessage& message, const Moment& at) { positions_.take(message, at); }
  /// Why topics of this robot do not connect as they must; empty: they do.
  void set_topic_problem(std::string problem) { topic_problem_ = std::move(problem); }

  /// The mission runs: from now on the robot may follow.
  /// @param oldest_fix_s  the age from which positions are too old for this mission
  /// @param exactly  whether only the commanded direction is safe
  void begin(const Box& domain, double oldest_fix_s, bool exactly);
  /// The velocity that the agent wants; 0: stand.
  void go(const Eigen::Vector3d& velocity_mps);
  /// The mission is over: zero velocity until it stands, for 1 s to 10 s, then done().
  void finish();
  bool done() const { return done_; }

  /// The velocity to send at `now`; nothing while none is due. It is sent 20 times a second from
  /// begin() to done(), and at once when it changes.
  std::optional<BodyVelocity> due(Instant now);
  Instant next_wakeup() const {
    return (running_ || finishing_) && !done_ ? next_ : Instant::max();
  }

  /// The newest position, if it can be trusted.
  std::optional<Fix> fix(Instant now) const;
  bool stands(Instant now) const;
  /// Why the robot does not follow its agent; empty if it does.
  std::string why_not(Instant now) const;
  /// Notes each change of it.
  void note_change(Instant now);
  std::vector<Note> take_notes() { return std::exchange(notes_, {}); }
  const DriveLimits& limits() const { return limits_; }

 private:
  DriveLimits limits_;
  Positions positions_;
  std::string topic_problem_;
  Box domain_;
  bool running_ = false, finishing_ = false, done_ = false, exactly_ = false;
  Eigen::Vector3d wanted_mps_{0, 0, 0};
  Instant next_{};
  int last_sent_ = 0;  // since the mission was over
  std::string last_why_ = "-";
  std::vector<Note> notes_;
};

}  // namespace ergocast::ros2
