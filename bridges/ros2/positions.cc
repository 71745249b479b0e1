// SPDX-License-Identifier: BSD-3-Clause
// Every message is checked by itself, and then compared with the one before it.
#include "bridges/ros2/positions.h"

#include <algorithm>
#include <cmath>

#include "text/printable.h"
#include "text/shortest.h"

namespace ergocast::ros2 {
namespace {

/// A quaternion's length may differ from 1 by so much.
constexpr double kRounded = 0.05;
/// A stamp that is older is no delay of the network, but of another clock [s].
constexpr double kOtherClock_s = 5;
constexpr std::size_t kLongestName = 60;

double seconds_of(std::int64_t ns) { return static_cast<double>(ns) * 1e-9; }

std::string rounded(double value) { return shortest(std::round(value * 100) / 100); }

/// A name from the network, for a line of the log.
std::string quoted(const std::string& name) {
  std::string text = name.substr(0, kLongestName) + (name.size() > kLongestName ? "…" : "");
  std::ranges::replace(text, '\n', ' ');
  return "'" + printable(text) + "'";
}

Eigen::Vector3d turned(const Eigen::Vector3d& v, double yaw_rad) {
  const double cosine = std::cos(yaw_rad), sine = std::sin(yaw_rad);
  return {cosine * v.x() - sine * v.y(), sine * v.x() + cosine * v.y(), v.z()};
}

/// The angle about z from the frame's x to the robot's x. @pre q has length 1
double yaw_of(const Eigen::Vector4d& q) {
  const double x = q[0], y = q[1], z = q[2], w = q[3];
  return std::atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z));
}

}  // namespace

std::string Positions::why_refused(const PoseMessage& message, const Moment& at) const {
  if (message.frame != frame_.name)
    return topic_ + " is in the frame " + quoted(message.frame) +
           ", and this bridge's file says frame: '" + frame_.name + "'";
  if (message.child_frame && !child_frame_.empty() && *message.child_frame != child_frame_)
    return topic_ + " is of the frame " + quoted(*message.child_frame) +
           ", and this bridge's file says base_frame: '" + child_frame_ + "'";
  const bool finite = message.position_m.allFinite() && message.orientation.allFinite() &&
                      (!message.body_velocity_mps || message.body_velocity_mps->allFinite());
  if (!finite) return topic_ + " has a value that is no number";
  if (std::abs(message.orientation.norm() - 1) > kRounded)
    return topic_ + " has an orientation that is no unit quaternion";
  const double age_s = seconds_of(at.wall_ns - message.stamp_ns);
  if (message.stamp_ns == 0) return topic_ + " has no stamp: its publisher must fill it in";
  if (age_s < -kMostFuture_s)
    return topic_ + " has a stamp " + rounded(-age_s) +
           " s in the future: synchronise the clocks of both machines";
  if (age_s > kOtherClock_s)
    return topic_ + " has a stamp " + rounded(age_s) +
           " s before this machine's clock: synchronise the clocks, and use no simulated time";
  return "";
}

void Positions::note_way(std::int64_t stamp_ns, const Eigen::Vector3d& position_m) {
  const double way_m = last_m_ ? (position_m - *last_m_).norm() : 0;
  const double passed_s = seconds_of(stamp_ns - last_ns_);
  if (last_m_ && way_m > kGreatestJump_m + 2 * max_speed_mps_ * passed_s) {
    unsteady_ = topic_ + " jumped by " + rounded(way_m) + " m: waits until it is steady for " +
                shortest(kSteady_s) + " s";
    steady_since_ns_ = stamp_ns;
  }
  if (seconds_of(stamp_ns - steady_since_ns_) >= kSteady_s) unsteady_.clear();
}

void Positions::take(const PoseMessage& message, const Moment& at) {
  if (std::string why = why_refused(message, at); !why.empty()) {
    problem_ = std::move(why);
    newest_.reset();
    return;
  }
  if (message.stamp_ns <= last_ns_) return;  // a repeat, or one that was overtaken
  Fix fix;
  fix.position_m = frame_.origin_m + turned(message.position_m, frame_.yaw_rad);
  fix.heading_rad = frame_.yaw_rad + yaw_of(message.orientation.normalized());
  note_way(message.stamp_ns, fix.position_m);
  if (message.body_velocity_mps) {
    fix.velocity_mps = turned(*message.body_velocity_mps, fix.heading_rad);
  } else if (last_m_) {
    fix.velocity_mps = (fix.position_m - *last_m_) / seconds_of(message.stamp_ns - last_ns_);
  }
  fix.measured = at.now - std::chrono::nanoseconds(at.wall_ns - message.stamp_ns);
  last_m_ = fix.position_m;
  last_ns_ = message.stamp_ns;
  newest_ = fix;
}

std::optional<Fix> Positions::at(Instant now) const {
  const bool young = newest_ && now - newest_->measured <= seconds(oldest_s_);
  return young && unsteady_.empty() ? newest_ : std::nullopt;
}

std::string Positions::problem(Instant now) const {
  if (at(now)) return "";
  if (!newest_) return problem_;
  if (!unsteady_.empty()) return unsteady_;
  return topic_ + " is silent or too slow: its newest position is older than " +
         rounded(oldest_s_) + " s";
}

}  // namespace ergocast::ros2
