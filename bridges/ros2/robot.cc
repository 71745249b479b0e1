// SPDX-License-Identifier: BSD-3-Clause
// Sends zero for whatever reason the robot must not follow.
#include "bridges/ros2/robot.h"

#include <chrono>

namespace ergocast::ros2 {
namespace {

using namespace std::chrono_literals;

/// Twice as often as robots need, so that one lost message makes no gap.
constexpr auto kPeriod = 50ms;
/// How many zeros it sends at the end, and at most where the robot does not stand yet.
constexpr int kLastZeros = 20, kMostLastZeros = 200;

}  // namespace

void Robot::begin(const Box& domain, double oldest_fix_s, bool exactly) {
  running_ = true;
  domain_ = domain;
  exactly_ = exactly;
  positions_.set_oldest(oldest_fix_s);
}

void Robot::go(const Eigen::Vector3d& velocity_mps) {
  if (velocity_mps != wanted_mps_) next_ = {};
  wanted_mps_ = velocity_mps;
}

void Robot::finish() {
  if (finishing_) return;
  finishing_ = true;
  done_ = !running_;  // it was never sent anything
  running_ = false;
  go({0, 0, 0});
}

std::optional<Fix> Robot::fix(Instant now) const {
  return topic_problem_.empty() ? positions_.at(now) : std::nullopt;
}

bool Robot::stands(Instant now) const {
  const auto fix = positions_.at(now);
  return fix && fix->velocity_mps.norm() < kStanding_mps;
}

/// A robot that is farther outside of the domain than its longer side has probably another frame.
std::string Robot::why_not(Instant now) const {
  if (!topic_problem_.empty()) return topic_problem_;
  if (std::string problem = positions_.problem(now); !problem.empty()) return problem;
  if (!running_) return finishing_ ? "the mission is over" : "waits for the mission";
  const Eigen::Vector3d at_m = positions_.at(now)->position_m;
  const double outside_m = (at_m - domain_.nearest(at_m)).head<2>().norm();
  if (outside_m > domain_.size_m.head<2>().maxCoeff())
    return "is far outside of the domain: is the origin of its frame right?";
  return "";
}

void Robot::note_change(Instant now) {
  const std::string why = why_not(now);
  if (why == last_why_) return;
  notes_.push_back({running_ && !why.empty(), why.empty() ? "follows its agent" : why});
  last_why_ = why;
}

std::optional<BodyVelocity> Robot::due(Instant now) {
  if ((!running_ && !finishing_) || done_ || now < next_) return std::nullopt;
  next_ = now + kPeriod;
  if (finishing_) {
    ++last_sent_;
    const bool waits = positions_.at(now) && !stands(now) && last_sent_ < kMostLastZeros;
    done_ = last_sent_ >= kLastZeros && !waits;
    return BodyVelocity{};
  }
  if (!why_not(now).empty()) return BodyVelocity{};
  return body_velocity(limits_, positions_.at(now)->heading_rad, wanted_mps_, exactly_);
}

}  // namespace ergocast::ros2
