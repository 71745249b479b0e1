// SPDX-License-Identifier: BSD-3-Clause
// Bodies that keep a distance: the last step of a command, whose result is feasible and safe.
//
// Body i holds the place y of every other body j relative to its own, ρ = ‖y‖. It is at most R from
// the true one at each tick at which the command of i may be executed:
//
//   R = V_j dt a + H dt (V_i + V_j) + e_i + e_j + w a + 2 H w
//
// a: age of y in ticks; H: ticks for which a command may be held; e: position error; w: what the
// world may add to a step. Among the steps with ‖d‖ ≤ V_i dt and x_i + d in the domain, it takes
// the one nearest to the wanted step that satisfies, for each j,
//
//   u·d ≤ κ s (ρ − R − D')  for every unit vector u within asin(R/ρ) of y,  s = V_i / (V_i + V_j).
//
// The bound is at least 0 unless disturbance or response time ask for more. Without them, and up to
// rounding, κ = 1 and D' = D. If two bodies both do so and are D' apart, they stay D' apart: the
// true unit vector n between them is such a u for both, so together they use at most the gap.
//
// Walls bound steps in the same way. They do not move, so a body may use the whole gap; the nearest
// point of each of their edges gives u. core/motion/separation_walls.cc has the sets.
//
// Bodies that are no points cannot stop at once. They keep apart the set that stays in place under
// commands of 0, core/motion/separation_pairs.cc. D' grows by how far the bodies may be from that
// set. So the two bodies of a pair may be different kinds of vehicles. docs/safety.md has the
// conditions and the proof.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/mission/mission.h"
#include "core/mission/zones.h"
#include "core/motion/step_constraints.h"
#include "core/motion/vehicle.h"
#include "core/motion/zones.h"

namespace ergocast {

/// A body, as another one knows it. Its number determines its vehicle, core/motion/vehicle.h.
struct Neighbour {
  AgentId id = kUnassigned;
  Eigen::Vector3d position_m{0, 0, 0};
  double max_speed_mps = 0;               ///< above 0; its hard limit
  Tick age_ticks = 0;                     ///< of the position; never less than the true age
  bool known = true;                      ///< false: it exists at an unknown place
  Eigen::Vector3d velocity_mps{0, 0, 0};  ///< at the tick
};

/// The body whose command is filtered.
struct Mover {
  AgentId id = kUnassigned;
  Tick tick = 0;
  Eigen::Vector3d position_m{0, 0, 0};
  double max_speed_mps = 0;
  Eigen::Vector3d velocity_mps{0, 0, 0};  ///< at the tick
};

struct SafeVelocity {
  Eigen::Vector3d velocity_mps{0, 0, 0};
  /// Whether a body or an edge leaves almost nothing: less than a tenth of the wanted step. A
  /// vehicle with inertia then brakes, and a fixed wing loiters.
  bool blocked = false;
  /// The neighbour that the wanted step would come too close to; kUnassigned if there is none, or
  /// if it is a wall or an edge of the domain.
  AgentId by = kUnassigned;
  /// Whether it is a wall that the wanted step would come too close to.
  bool wall = false;
  /// Whether it stands because a neighbour is unknown, or may be anywhere around.
  bool blind = false;
};

class SeparationFilter {
 public:
  /// If the mission keeps no distance, only walls, edges and the vehicle's own limits count.
  /// @param hold_ticks  for how many ticks after its own one a command may still be executed
  SeparationFilter(const Mission& mission, Tick hold_ticks);

  /// From now on the zones of this list count, each at the ticks at which it is closed, and for
  /// bodies that it binds (core/motion/zones.h).
  void set_zones(std::span<const Zone> zones);

  /// The part of `wanted_mps` that `self` may execute: all of it, bit for bit, if that is allowed.
  /// For vehicles that are no points it is the velocity at the tick's end, which the vehicle can
  /// reach. The result depends on the arguments alone. In a lockstep mission all positions are
  /// those of `self.tick`. No call allocates memory.
  /// @param others  in ascending order of their numbers; an entry of `self` is ignored
  SafeVelocity safe(const Mover& self, const Eigen::Vector3d& wanted_mps,
                    std::span<const Neighbour> others);

  /// The distance at which two bodies count as in contact: their D' [m]. For fixed wings it is the
  /// distance of their loiter centres.
  double contact_m(AgentId one, AgentId other) const;

  /// R: how far the place of `other` may be from the known one, relative to `self` [m].
  double uncertainty_m(const Mover& self, const Neighbour& other) const;

 private:
  /// What follows for two bodies from their kinds alone.
  struct Pair {
    double kept_m;    ///< D'
    double around_m;  ///< distances of the two bodies from their holding sets, added up
    double reach_m;   ///< how far the first can move in a tick
  };

  const Motion& motion_of(AgentId id) const;
  const Pair& pair_of(AgentId one, AgentId other) const;
  Pair pair_between(const Motion& one, const Motion& other) const;
  double margin_m(double fastest_mps) const;
  void begin(const Mover& self, double reach_m);
  double kept_late_m(const Mover& self, double clearance_m) const;
  double unsure_of_place_m(const Mover& self) const;
  double reached_m(const Mover& self, double clearance_m) const;
  void take(AgentId whose, const StepConstraints::Set& set);
  void keep_from_walls(const Mover& self, const StraightWay& own);
  void keep_from_wall(const Mover& self, const StraightWay& own, const Segment& edge,
                      double kept_m);
  void keep_from_zones(const Mover& self, const StraightWay& own);
  void keep_from_plane(const Mover& self, const StraightWay& own, const Eigen::Vector3d& y_m,
                       double square_m2, double kept_m);
  SafeVelocity blocked_by(const Eigen::Vector3d& wanted_m) const;
  double side(const Mover& self) const;
  SafeVelocity stopped(const Mover& self, const Neighbour& other) const;
  SafeVelocity safe_step(const Mover& self, const Eigen::Vector3d& wanted_mps,
                         std::span<const Neighbour> others);
  Eigen::Vector3d sideways(const Mover& self, const Eigen::Vector3d& wanted_m) const;
  SafeVelocity safe_change(const Mover& self, const Eigen::Vector3d& wanted_mps,
                           std::span<const Neighbour> others);
  SafeVelocity safe_arc(const Mover& self, const Eigen::Vector3d& wanted_mps,
                        std::span<const Neighbour> others);
  SafeVelocity safe_circle(const Mover& self, const Eigen::Vector3d& wanted_mps,
                           std::span<const Neighbour> others);
  Eigen::Vector3d center_step_m(const Mover& self, const Eigen::Vector3d& v_mps) const;
  bool allows(const Mover& self, const Eigen::Vector3d& v_mps) const;
  const Neighbour* keep_from_all(const Mover& self, std::span<const Neighbour> others);
  bool keep_from(const Mover& self, const StraightWay& own, const Neighbour& other);
  bool keep_places_apart(const Mover& self, const Neighbour& other, const Eigen::Vector3d& y_m);
  bool keep_ways_apart(const Mover& self, const Neighbour& other, const StraightWay& own,
                       const StraightWay& theirs);

  Mission mission_;
  std::vector<Motion> motions_;  // of each kind of agents; at least one
  double hold_ticks_, gain_, rounding_m_;
  std::vector<Pair> pairs_;  // of each kind with each
  StepConstraints constraints_;
  std::vector<AgentId> taken_;             // body of each constraint; kUnassigned: a wall
  std::vector<std::uint32_t> near_;        // scratch: the edges of walls near the body
  std::vector<double> kept_from_walls_m_;  // by each kind of agents
  std::vector<Zone> zones_;
  std::vector<double> kept_from_zones_m_, bound_from_zones_m_;  // by each kind of agents
};

/// κ, the share of a gap that two bodies may close in a tick: 1, or min(1, dt/4T) if they follow
/// their commands late. With a greater share they would overshoot.
double closing_gain(const Mission& mission);

}  // namespace ergocast
