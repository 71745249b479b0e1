// SPDX-License-Identifier: BSD-3-Clause
// The vehicles of the simulated world: which agent drives each, where it is, and how it moves.
//
//   x_{n+1} = reflect(x_n + v_n dt + σ_w √dt ξ),  ξ: the actuation disturbance, off by default.
//   v_n is the command, cut to the vehicle's speed limit. Where bodies keep a distance, a world in
//   real time then filters all commands together (core/motion/separation.h). Old and late commands
//   do not account for where the others have gone. Where there are walls, a world always filters,
//   and these stop ξ. A physics may move the bodies instead (physics.h), and x_{n+1} is its
//   result.
//
// fleet.cc has members, commands and steps, placing.cc has where vehicles begin.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/ids.h"
#include "core/measure/objects.h"
#include "core/mission/mission.h"
#include "core/mission/roster.h"
#include "core/mission/zones.h"
#include "core/motion/filter_rules.h"
#include "core/motion/separation.h"
#include "core/search/reports.h"
#include "sim/command_history.h"
#include "sim/physics.h"
#include "team/messages.h"
#include "team/state_assembler.h"

namespace ergocast {

/// Whether a restarted world begins from a state of all bodies, because their commands alone do not
/// determine their motion.
inline bool begins_by_state(const Mission& mission) {
  return keeps_distance(mission) || !mission.walls.empty();
}

/// What a new vehicle finds where it is placed.
enum class Surroundings {
  kPlanned,   ///< the world does not know yet where the vehicles are
  kStanding,  ///< no vehicle moves yet, so less distance is enough
  kMoving,
};

class Fleet {
 public:
  /// @param physics  what moves the bodies; without it core/motion/vehicle.h does
  explicit Fleet(PhysicsMaker physics) : physics_maker_(std::move(physics)) {}

  /// Takes in the mission, once it is known, and makes the physics. Otherwise returns why that
  /// fails. Later calls do nothing.
  std::optional<std::string> learn(const Mission& mission);

  // ---- members, of a known mission ----

  /// Takes in which incarnations drive. A vehicle whose agent has left keeps its place, and a new
  /// member's vehicle gets one.
  void take_roster(const std::vector<RosterEntry>& roster, Surroundings surroundings);
  /// The commands of the incarnation that drives a vehicle; null if `sender` drives none.
  CommandHistory* commands_of(const Header& sender);
  /// The tick that the newest command for this vehicle answers; −1: none. @pre it exists
  Tick answered(AgentId id) const { return vehicles_.at(id).commands.answered(); }
  /// The newest of all vehicles. −1 if agents have answered none; nothing without any command.
  std::optional<Tick> newest_answer() const;
  /// The newest of the vehicles that an agent drives; −1: none.
  Tick newest_answer_of_members() const;
  /// Whether all members have answered `tick`, and there is a member.
  bool everyone_answered(Tick tick) const;
  /// The members that have not answered `tick`.
  int late_members(Tick tick) const;
  /// The first member of which the last two commands are not known; kUnassigned: none.
  AgentId first_unheard() const;

  /// Takes in the zones of the newest list.
  void take_zones(const std::vector<Zone>& zones);

  // ---- beginning ----

  /// Puts every vehicle where it is at `tick`, by `before` if begins_by_state(), else by its
  /// agent's last two commands.
  /// @param before  a state with all bodies, from a world before this one
  void begin(Tick tick, const StateAssembler& before, Surroundings surroundings);

  // ---- moving ----

  /// Moves all vehicles from `tick` to the next tick.
  void step(Tick tick);
  /// Charges the batteries of vehicles at their stations for a tick that counts. The others use
  /// theirs.
  void use_batteries();
  /// Lets a tick pass in which no vehicle moves, but for bodies with mass, which roll on.
  void stop();

  /// The parts of the state of `tick` with all vehicles. Only part numbers and vehicles are filled
  /// in.
  std::vector<WorldState> snapshot(Tick tick);
  /// Steps of a vehicle that the speed limit made slower than its command.
  std::int64_t clamped_commands() const { return clamped_commands_; }
  /// The summary of the physics; empty without one.
  std::string physics_summary() const { return physics_ ? physics_->summary() : ""; }

 private:
  struct Slot {
    Author author;  // incarnation 0: no agent drives it
    Eigen::Vector3d x_m{0, 0, 0};
    Eigen::Vector3d applied_mps{0, 0, 0};  // in the step that led here; with inertia, at its end
    Eigen::Vector3d next_mps{0, 0, 0};     // in the step that follows
    CommandHistory commands;
    bool placed = true;  // false: x_m is not known yet
    double charge = 1;   // the share that is left in its battery

    bool has_driver() const { return author.incarnation != 0; }
    bool driven(Tick tick, const Timing& timing) const {
      return has_driver() && charge > 0 && commands.in_force(tick, timing);
    }
  };

  bool filters_always() const;
  Eigen::Vector3d place_for(AgentId id, Surroundings surroundings) const;
  void settle(Tick tick, const StateAssembler& before, Surroundings surroundings);
  void recall(AgentId id, Slot& slot, Tick now);
  void keep_from_walls(AgentId id, Slot& slot, Tick tick);
  void filter_commands(Tick tick);
  void move_bodies();
  void place(AgentId id, Slot& slot, const Eigen::Vector3d& x_m) const;
  void drive(AgentId id, Slot& slot, Tick tick) const;
  void move(AgentId id, Slot& slot, Tick tick) const;

  std::optional<Mission> mission_;
  Objects objects_;
  Reports reports_;
  std::map<AgentId, Slot> vehicles_;
  std::optional<SeparationFilter>
      filter_;                     // if it guards, has walls or zones, or a body is no point
  std::vector<Neighbour> bodies_;  // of the tick, for the guard
  std::vector<Zone> zones_;
  PhysicsMaker physics_maker_;
  std::unique_ptr<Physics> physics_;  // null: core/motion/vehicle.h
  std::vector<PhysicalBody> moved_;
  std::int64_t clamped_commands_ = 0;
};

}  // namespace ergocast
