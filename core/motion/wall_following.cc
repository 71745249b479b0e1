// SPDX-License-Identifier: BSD-3-Clause
// Looks back once in a window, and finds the way along the nearest wall that no other wall ends.
#include "core/motion/wall_following.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/geometry.h"
#include "core/base/noise.h"
#include "core/motion/vehicle.h"
#include "core/motion/walls.h"

namespace ergocast {
namespace {

/// An agent is held up if it gets less far than this share of the wanted way.
constexpr double kHeldUpShare = 0.2;
/// The distance within which a wall is at hand, as a multiple of the longest step.
constexpr double kAtHandSteps = 2;
constexpr double kMemory_s = 30;
constexpr std::ptrdiff_t kMostEdges = 64;

}  // namespace

WallFollower::WallFollower(const Mission& mission, AgentId id)
    : seed_(mission.seed),
      dt_s_(mission.timing.dt_s),
      domain_(mission.domain),
      walls_(mission.walls),
      id_(id),
      limit_mps_(motion_of(mission, id).speed_limit_mps),
      kept_m_(kept_from_walls_m(mission, motion_of(mission, id))),
      reach_m_(ergocast::reach_m(motion_of(mission, id), motion_of(mission, id).speed_limit_mps)) {
  near_.reserve(walls_.edge_count());
}

double WallFollower::seconds_since(Tick tick, Tick before) const {
  return static_cast<double>(tick - before) * dt_s_;
}

void WallFollower::begin_window(Tick tick, const Eigen::Vector3d& x_m) {
  window_ = tick;
  from_m_ = x_m;
  wanted_m_ = 0;
  wall_ticks_ = ticks_ = 0;
}

void WallFollower::look_back(Tick tick, const Eigen::Vector3d& x_m) {
  const bool held_up =
      length_of(x_m - from_m_) < kHeldUpShare * wanted_m_ && 2 * wall_ticks_ >= ticks_;
  begin_window(tick, x_m);
  if (!held_up) return;
  // An agent may move freely for a while on its way back into the same dead end.
  const bool again = length_s_ > 0 && seconds_since(tick, since_) < kMemory_s + 2 * length_s_;
  length_s_ = again ? std::min(2 * length_s_, kLongest_s) : kShortest_s;
  follows_ = true;
  since_ = tick;
  const RandomBits bits = random_words(seed_, Purpose::kHand, static_cast<std::uint32_t>(id_),
                                       static_cast<std::uint64_t>(tick));
  side_ = bits.first >> 63 == 0 ? 1 : -1;
}

Eigen::Vector3d WallFollower::aim(Tick tick, const Eigen::Vector3d& x_m,
                                  const Eigen::Vector3d& wanted_mps) {
  if (window_ < 0) begin_window(tick, x_m);
  if (follows_ && seconds_since(tick, since_) >= length_s_) {
    follows_ = false;
    since_ = tick;
    begin_window(tick, x_m);
  }
  if (!follows_ && seconds_since(tick, window_) >= kWindow_s) look_back(tick, x_m);
  ++ticks_;
  wanted_m_ += std::min(length_of(wanted_mps) * dt_s_, reach_m_);
  if (!follows_) return wanted_mps;
  Eigen::Vector2d way = along_wall(x_m.head<2>());
  if (at_edge(x_m, way)) {
    side_ = -side_;
    way = along_wall(x_m.head<2>());
  }
  return std::min(length_of(wanted_mps), limit_mps_) * on_ground(way);
}

/// The way along a wall at hand, if possible one along which no other wall is in the way, else the
/// nearest. Away from the wall, as behind a corner, the way leads a little towards it.
Eigen::Vector2d WallFollower::along_wall(const Eigen::Vector2d& x_m) {
  const double at_hand_m = kept_m_ + kAtHandSteps * reach_m_;
  double best_m = std::numeric_limits<double>::max();
  Eigen::Vector2d best(1, 0);
  // A wall in the way makes one at hand count as farther by at_hand_m at most.
  const double nearest_m = std::sqrt(walls_.least_square_m2(x_m, 0));
  const double within_m = nearest_m < at_hand_m ? nearest_m + at_hand_m : nearest_m;
  for (const std::uint32_t number : nearest_edges(x_m, within_m)) {
    const Eigen::Vector2d to_m = walls_.edges()[number].segment.nearest_m(x_m) - x_m;
    const double apart_m = std::sqrt(to_m.squaredNorm());
    if (!(apart_m > 0) || apart_m >= best_m) continue;
    const Eigen::Vector2d n = to_m / apart_m, along = side_ * Eigen::Vector2d(n.y(), -n.x());
    // A wall in the way makes this one count as farther.
    const double far_m =
        apart_m + (apart_m < at_hand_m ? in_the_way(x_m, along, at_hand_m) * at_hand_m : 0);
    if (far_m >= best_m) continue;
    best_m = far_m;
    const double off = std::clamp((apart_m - kept_m_) / (kAtHandSteps * reach_m_), 0.0, 1.0);
    best = (along + off * n) / std::sqrt(1 + off * off);
  }
  return best;
}

/// The edges within a distance, in order, and at most the nearest kMostEdges: each is held against
/// all others, and a plan may have thousands at hand.
std::span<const std::uint32_t> WallFollower::nearest_edges(const Eigen::Vector2d& x_m,
                                                           double within_m) {
  walls_.for_near({x_m, x_m}, within_m, near_, [](const Segment&) {});
  if (std::ssize(near_) <= kMostEdges) return near_;
  const auto rank = [&](std::uint32_t number) {
    const Segment& edge = walls_.edges()[number].segment;
    return std::pair((edge.nearest_m(x_m) - x_m).squaredNorm(), number);
  };
  const auto end = near_.begin() + kMostEdges;
  std::ranges::nth_element(near_, end, {}, rank);
  std::sort(near_.begin(), end);
  return {near_.begin(), end};
}

/// How directly a way leads into any wall at hand: 0 to 1.
double WallFollower::in_the_way(const Eigen::Vector2d& x_m, const Eigen::Vector2d& way,
                                double at_hand_m) const {
  double most = 0;
  walls_.find_near({x_m, x_m}, at_hand_m, [&](const Edge& edge) {
    const Eigen::Vector2d to_m = edge.segment.nearest_m(x_m) - x_m;
    const double apart_m = std::sqrt(to_m.squaredNorm());
    if (apart_m > 0 && apart_m < at_hand_m) most = std::max(most, way.dot(to_m) / apart_m);
    return false;
  });
  return most;
}

/// Whether the way leads out of the domain within a step.
bool WallFollower::at_edge(const Eigen::Vector3d& x_m, const Eigen::Vector2d& way) const {
  const Eigen::Vector3d then_m = x_m + reach_m_ * on_ground(way);
  return !domain_.contains(then_m);
}

}  // namespace ergocast
