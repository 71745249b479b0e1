// SPDX-License-Identifier: BSD-3-Clause
// Robots in the physics engine MuJoCo, which replace the simulated world's vehicles. The engine
// steps with the ticks and uses no clock, so equal missions give equal numbers.
#pragma once

#include <mujoco/mujoco.h>

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "examples/mujoco/pilot.h"
#include "examples/mujoco/room.h"
#include "sim/physics.h"

namespace ergocast::mujoco {

/// Counts contacts. A pair that touches in one tick, however often, counts once.
struct Contacts {
  std::int64_t robots = 0;  ///< two robots
  std::int64_t walls = 0;   ///< a robot and a wall
};

class MujocoPhysics : public Physics {
 public:
  /// @pre the mission is in a plane
  MujocoPhysics(const Mission& mission, const RobotDesign& design);

  void place(AgentId id, const Eigen::Vector3d& position_m,
             const Eigen::Vector3d& velocity_mps) override;
  void pass_tick(std::span<PhysicalBody> bodies) override;

  /// From now on disc `id` rolls so, whatever pass_tick() wants of it.
  /// @param turn_radps  counter-clockwise
  /// @pre it was placed
  void roll(AgentId id, double ahead_mps, double turn_radps);
  /// @pre a tick has passed since `id` was placed
  RobotState state(AgentId id) const { return state_of(robots_.at(id)); }

  std::string summary() const override;

  /// From now on a quadrotor holds this height of its centre; before it holds kHoverHeight_m.
  /// @pre the robot was placed
  void hold_height(AgentId id, double height_m) { robots_.at(id).held_m = height_m; }
  /// @pre a tick has passed since the robot was placed
  double height_m(AgentId id) const { return state_of(robots_.at(id)).position_m.z(); }

  const Contacts& contacts() const { return contacts_; }
  /// For pictures.
  const mjModel* model() const { return model_.get(); }
  mjData* data() { return data_.get(); }

 private:
  /// The state of a robot. It outlives the engine's model, which is made again for each new robot.
  struct Robot {
    Robot(const RobotDesign& design) : disc(design), quadrotor(design) {}
    Eigen::Vector3d place_m{0, 0, 0}, velocity_mps{0, 0, 0};
    double held_m = kHoverHeight_m;
    bool to_place = true;
    std::optional<std::array<double, 2>> wheels_radps;  // of roll()
    std::vector<double> qpos, qvel, act;                // kept while the model is made again
    int body = 0, qpos_at = 0, dof_at = 0, act_at = 0;  // indices in the model
    DiscPilot disc;
    QuadrotorPilot quadrotor;
  };
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };

  bool rolls() const { return design_.kind == RobotKind::kDisc; }
  void save();
  void build();
  void find_owners();
  void put_in_place(Robot& robot);
  void steer(Robot& robot, const Eigen::Vector3d& wanted_mps);
  RobotState state_of(const Robot& robot) const;
  void note_contacts();

  RobotDesign design_;
  Box domain_;
  Rings walls_;
  int steps_;  // in a tick
  double step_s_;
  bool stale_ = true;  // the model lacks a robot
  std::map<AgentId, Robot> robots_;
  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
  std::vector<AgentId> owner_;                      // of each geom: its robot, kWall or kNobody
  std::set<std::pair<AgentId, AgentId>> touching_;  // in this tick
  Contacts contacts_;
};

/// For a world whose missions suit these robots: in a plane, with point vehicles.
/// @param made  set to the newest physics, which the world owns; may be null
PhysicsMaker mujoco_physics(const RobotDesign& design, MujocoPhysics** made = nullptr);

}  // namespace ergocast::mujoco
