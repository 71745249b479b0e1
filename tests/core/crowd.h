// SPDX-License-Identifier: BSD-3-Clause
// Bodies that want to be where others are, with all that can happen to what they know: loss, age,
// held and late commands, errors, restarts, disturbances. The filter must keep them apart.
//
// A flaw withholds from the filter one thing that it needs. Each flaw must be seen to break the
// distance, else the attack would prove nothing.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "core/base/geometry.h"
#include "core/mission/mission.h"
#include "core/motion/separation.h"

namespace ergocast::test {

enum class Flaw {
  kNone,
  kWholeGap,  ///< each takes the whole gap instead of its share
  kNoAge,     ///< old positions count as new
  kHalfAge,
  kNoHold,  ///< a command is believed to end with its tick
  kNoError,
  kNoMargin,         ///< no margin for disturbances
  kFirstTwo,         ///< only two neighbours count
  kUnknownIgnored,   ///< a body of unknown place counts as absent
  kEdgesAfterwards,  ///< the filter knows no edges; the world folds at them
};

struct Attack {
  int bodies = 12;
  int ticks = 1000;
  double side_m = 200, distance_m = 30, max_speed_mps = 40;
  bool in_space = false;
  double loss = 0;      ///< share of positions that are not received
  Tick hold_ticks = 0;  ///< for how long a command is executed if no newer one arrives
  double late = 0;      ///< share of commands that arrive 1 … hold_ticks later
  int compute_each = 1;
  double error_m = 0;
  double disturbance_m = 0;
  double slowest_mps = 0;  ///< 0: all have the same limit
  double forget = 0;       ///< chance that a body forgets all others in a tick
  bool all_to_one = false;
  bool beyond_edges = false;  ///< goals lie up to D outside of the domain
  Flaw flaw = Flaw::kNone;
  unsigned seed = 1;
};

class Crowd {
 public:
  explicit Crowd(const Attack& attack)
      : attack_(attack), draw_(attack.seed), mission_(mission_of(attack)) {
    if (attack_.flaw == Flaw::kEdgesAfterwards) {
      mission_.domain.origin_m.array() -= 1000;
      mission_.domain.size_m.array() += 2000;
      if (!attack_.in_space) mission_.domain.origin_m.z() = mission_.domain.size_m.z() = 0;
    }
    const Tick hold = attack_.flaw == Flaw::kNoHold ? 0 : attack_.hold_ticks;
    filter_.emplace_back(mission_, hold);
    place();
  }

  /// The shortest distance of two bodies less D, over all ticks [m].
  double least_spare_m() {
    double least_m = 1e300;
    for (Tick tick = 0; tick < attack_.ticks; ++tick) {
      step(tick);
      for (std::size_t i = 0; i < bodies_.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
          least_m = std::min(least_m, (bodies_[i].x_m - bodies_[j].x_m).norm());
        }
      }
    }
    return least_m - attack_.distance_m;
  }
  double blocked_share() const { return static_cast<double>(blocked_) / static_cast<double>(all_); }
  int arrivals() const { return arrivals_; }
  int contacts() const { return contacts_; }

 private:
  struct Sent {
    Tick tick, arrives;
    Eigen::Vector3d v_mps;
  };
  struct Body {
    Eigen::Vector3d x_m, goal_m;
    double max_speed_mps;
    std::vector<Neighbour> others;  // age_ticks: the tick when it was seen
    std::vector<Sent> sent;
  };

  static Mission mission_of(const Attack& attack) {
    Mission mission;
    mission.seed = attack.seed;
    mission.domain.size_m = {attack.side_m, attack.side_m, attack.in_space ? attack.side_m : 0};
    mission.speed_limit_mps = attack.max_speed_mps;
    mission.separation.distance_m = attack.distance_m;
    if (attack.flaw != Flaw::kNoError) mission.separation.position_error_m = attack.error_m;
    if (attack.flaw != Flaw::kNoMargin) mission.separation.disturbance_m = attack.disturbance_m;
    return mission;
  }

  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(draw_);
  }
  Box domain() const { return mission_of(attack_).domain; }
  Eigen::Vector3d place_in_domain() {
    const double z = attack_.in_space ? between(0, attack_.side_m) : 0;
    return {between(0, attack_.side_m), between(0, attack_.side_m), z};
  }
  /// At most `longest_m` long.
  Eigen::Vector3d vector(double longest_m) {
    Eigen::Vector3d v(between(-1, 1), between(-1, 1), attack_.in_space ? between(-1, 1) : 0);
    return v.norm() > 1 ? Eigen::Vector3d(v.normalized() * longest_m)
                        : Eigen::Vector3d(v * longest_m);
  }
  Eigen::Vector3d goal() {
    if (attack_.all_to_one) return domain().center_m();
    if (!attack_.beyond_edges) return place_in_domain();
    const double share = 1 + 2 * attack_.distance_m / attack_.side_m;
    return domain().center_m() + share * (place_in_domain() - domain().center_m());
  }

  void place() {
    const double dt_s = mission_.timing.dt_s;
    const double apart_m =
        attack_.distance_m + 4 * attack_.error_m + 1e-3 +
        2 * static_cast<double>(attack_.hold_ticks) * 2 * attack_.max_speed_mps * dt_s;
    while (bodies_.size() < static_cast<std::size_t>(attack_.bodies)) {
      const Eigen::Vector3d x_m = place_in_domain();
      const bool free = std::all_of(bodies_.begin(), bodies_.end(), [&](const Body& body) {
        return (body.x_m - x_m).norm() >= apart_m;
      });
      if (!free) continue;
      const double limit_mps = attack_.slowest_mps > 0
                                   ? between(attack_.slowest_mps, attack_.max_speed_mps)
                                   : attack_.max_speed_mps;
      bodies_.push_back({x_m, goal(), limit_mps, {}, {}});
    }
    for (Body& body : bodies_) {
      for (std::size_t j = 0; j < bodies_.size(); ++j) {
        body.others.push_back(
            {static_cast<AgentId>(j), {0, 0, 0}, bodies_[j].max_speed_mps, 0, false});
      }
    }
  }

  void step(Tick tick) {
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      receive(bodies_[i], tick);
      if ((tick + static_cast<Tick>(i)) % attack_.compute_each == 0) command(i, tick);
    }
    std::vector<Eigen::Vector3d> next_m;
    for (const Body& body : bodies_) next_m.push_back(moved_to(body, tick));
    for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i].x_m = next_m[i];
  }

  void receive(Body& body, Tick tick) {
    const bool forgets = between(0, 1) < attack_.forget;
    for (std::size_t j = 0; j < bodies_.size(); ++j) {
      Neighbour& other = body.others[j];
      if (forgets) other.known = false;
      if (between(0, 1) < attack_.loss) continue;
      other.position_m = bodies_[j].x_m + vector(attack_.error_m);
      other.age_ticks = tick;
      other.known = true;
    }
  }

  void command(std::size_t i, Tick tick) {
    Body& body = bodies_[i];
    if (!attack_.all_to_one && (body.goal_m - body.x_m).norm() < attack_.distance_m / 2) {
      body.goal_m = goal();
      ++arrivals_;
    }
    std::vector<Neighbour> others;
    for (Neighbour other : body.others) {
      other.age_ticks = tick - other.age_ticks;
      if (flawed(other, i, others.size())) continue;
      others.push_back(other);
    }
    const Eigen::Vector3d wanted_mps =
        (body.goal_m - body.x_m).normalized() * (1.2 * body.max_speed_mps);
    const Mover self{static_cast<AgentId>(i), tick, body.x_m + vector(attack_.error_m),
                     body.max_speed_mps};
    const SafeVelocity safe = filter_.front().safe(self, wanted_mps, others);
    ++all_;
    if (safe.blocked) ++blocked_;
    if (safe.by >= 0) ++contacts_;
    const Tick delay =
        between(0, 1) < attack_.late ? static_cast<Tick>(between(1, attack_.hold_ticks + 1)) : 0;
    body.sent.push_back({tick, tick + delay, within_speed(safe.velocity_mps, body.max_speed_mps)});
  }

  /// Applies the flaw to `other`; true: it is left out.
  bool flawed(Neighbour& other, std::size_t self, std::size_t taken) const {
    if (other.id == static_cast<AgentId>(self)) return true;
    switch (attack_.flaw) {
      case Flaw::kWholeGap:
        other.max_speed_mps = 1e-9;
        return false;
      case Flaw::kNoAge:
        other.age_ticks = 0;
        return false;
      case Flaw::kHalfAge:
        other.age_ticks /= 2;
        return false;
      case Flaw::kFirstTwo:
        return taken == 2;
      case Flaw::kUnknownIgnored:
        return !other.known;
      default:
        return false;
    }
  }

  Eigen::Vector3d moved_to(const Body& body, Tick tick) {
    const Sent* newest = nullptr;
    for (const Sent& one : body.sent) {
      if (one.arrives <= tick && (newest == nullptr || one.tick > newest->tick)) newest = &one;
    }
    Eigen::Vector3d next_m = body.x_m + vector(attack_.disturbance_m);
    if (newest != nullptr && tick - newest->tick <= attack_.hold_ticks) {
      next_m += newest->v_mps * mission_.timing.dt_s;
    }
    return reflect(next_m, domain());
  }

  Attack attack_;
  std::mt19937 draw_;
  Mission mission_;
  std::vector<SeparationFilter> filter_;
  std::vector<Body> bodies_;
  long all_ = 0, blocked_ = 0;
  int arrivals_ = 0, contacts_ = 0;
};

}  // namespace ergocast::test
