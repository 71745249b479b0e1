// SPDX-License-Identifier: BSD-3-Clause
// Makes the engine's model, steers every robot before each of its steps, and counts contacts.
#include "examples/mujoco/mujoco_physics.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "core/base/require.h"
#include "core/motion/vehicle.h"

namespace ergocast::mujoco {
namespace {

constexpr AgentId kNobody = -2, kWall = -1;

/// The engine's memory grows with the square of the contacts that it may have to solve.
constexpr std::size_t kMostRobots = 128;

constexpr int kQpos = 7, kQvel = 6;  // of a free body

mjModel* compiled(const std::string& mjcf) {
  const auto files = std::make_unique<mjVFS>();
  mj_defaultVFS(files.get());
  const int size = static_cast<int>(mjcf.size());
  ERGOCAST_REQUIRE(mj_makeEmptyFileVFS(files.get(), "room.xml", size) == 0);
  std::memcpy(files->filedata[0], mjcf.data(), mjcf.size());
  char error[1000] = "";
  mjModel* model = mj_loadXML("room.xml", files.get(), error, sizeof error);
  mj_deleteVFS(files.get());
  if (model == nullptr) throw std::runtime_error(std::string("MuJoCo refuses the room: ") + error);
  return model;
}

int named(const mjModel* model, mjtObj type, const std::string& name) {
  const int id = mj_name2id(model, type, name.c_str());
  ERGOCAST_REQUIRE(id >= 0);
  return id;
}

}  // namespace

MujocoPhysics::MujocoPhysics(const Mission& mission, const RobotDesign& design)
    : design_(design),
      domain_(mission.domain),
      walls_(mission.walls),
      steps_(static_cast<int>(std::ceil(mission.timing.dt_s / kLongestStep_s))),
      step_s_(mission.timing.dt_s / steps_) {
  ERGOCAST_REQUIRE(mission.domain.planar());
}

void MujocoPhysics::place(AgentId id, const Eigen::Vector3d& position_m,
                          const Eigen::Vector3d& velocity_mps) {
  const auto [at, is_new] = robots_.try_emplace(id, design_);
  stale_ = stale_ || is_new;
  at->second.place_m = position_m;
  at->second.velocity_mps = velocity_mps;
  at->second.to_place = true;
}

void MujocoPhysics::roll(AgentId id, double ahead_mps, double turn_radps) {
  robots_.at(id).wheels_radps = wheels_radps(design_, ahead_mps, turn_radps);
}

void MujocoPhysics::pass_tick(std::span<PhysicalBody> bodies) {
  if (stale_) build();
  for (auto& [id, robot] : robots_) {
    if (robot.to_place) put_in_place(robot);
  }
  mj_forward(model_.get(), data_.get());
  touching_.clear();
  for (int step = 0; step < steps_; ++step) {
    for (const PhysicalBody& body : bodies) steer(robots_.at(body.id), body.wanted_mps);
    mj_step(model_.get(), data_.get());
    note_contacts();
  }
  for (const auto& [one, other] : touching_) ++(one == kWall ? contacts_.walls : contacts_.robots);
  for (PhysicalBody& body : bodies) {
    const RobotState state = state_of(robots_.at(body.id));
    body.position_m = {state.position_m.x(), state.position_m.y(), 0};
    body.velocity_mps = {state.velocity_mps.x(), state.velocity_mps.y(), 0};
  }
}

/// Saves the state of all robots in the model for the next model.
void MujocoPhysics::save() {
  const int acts = rolls() ? 2 : 4, qpos = rolls() ? kQpos + 2 : kQpos, qvel = qpos - 1;
  for (auto& [id, robot] : robots_) {
    if (robot.body == 0) continue;
    const double* const from = data_->qpos + robot.qpos_at;
    robot.qpos.assign(from, from + qpos);
    robot.qvel.assign(data_->qvel + robot.dof_at, data_->qvel + robot.dof_at + qvel);
    robot.act.assign(data_->act + robot.act_at, data_->act + robot.act_at + acts);
  }
}

void MujocoPhysics::build() {
  if (data_) save();
  std::vector<Placement> placements;
  for (const auto& [id, robot] : robots_) placements.push_back({id, robot.place_m});
  model_.reset(compiled(room_mjcf(design_, domain_, walls_, step_s_, placements)));
  data_.reset(mj_makeData(model_.get()));
  for (auto& [id, robot] : robots_) {
    const std::string number = std::to_string(id);
    const int joint = named(model_.get(), mjOBJ_JOINT, "joint" + number);
    const std::string actuator = rolls() ? "left" + number : "rotor" + number + "_0";
    robot.body = named(model_.get(), mjOBJ_BODY, "robot" + number);
    robot.qpos_at = model_->jnt_qposadr[joint];
    robot.dof_at = model_->jnt_dofadr[joint];
    // Each actuator has one activation value.
    robot.act_at = named(model_.get(), mjOBJ_ACTUATOR, actuator);
    std::copy(robot.qpos.begin(), robot.qpos.end(), data_->qpos + robot.qpos_at);
    std::copy(robot.qvel.begin(), robot.qvel.end(), data_->qvel + robot.dof_at);
    std::copy(robot.act.begin(), robot.act.end(), data_->act + robot.act_at);
  }
  find_owners();
  stale_ = false;
}

void MujocoPhysics::find_owners() {
  owner_.assign(static_cast<std::size_t>(model_->ngeom), kNobody);
  for (const auto& [id, robot] : robots_) {
    const int chassis = named(model_.get(), mjOBJ_GEOM, "chassis" + std::to_string(id));
    owner_[static_cast<std::size_t>(chassis)] = id;
  }
  for (int geom = 0; geom < model_->ngeom; ++geom) {
    const char* name = mj_id2name(model_.get(), mjOBJ_GEOM, geom);
    if (name != nullptr && std::strncmp(name, "wall", 4) == 0)
      owner_[static_cast<std::size_t>(geom)] = kWall;
  }
}

/// It points along its motion; a standing robot points at the middle of the room.
void MujocoPhysics::put_in_place(Robot& robot) {
  robot.to_place = false;
  const Eigen::Vector3d middle_m = domain_.origin_m + domain_.size_m / 2;
  const Eigen::Vector3d look =
      robot.velocity_mps.isZero() ? Eigen::Vector3d(middle_m - robot.place_m) : robot.velocity_mps;
  const double heading_rad = rolls() ? std::atan2(look.y(), look.x()) : 0;
  double* const qpos = data_->qpos + robot.qpos_at;
  double* const qvel = data_->qvel + robot.dof_at;
  std::fill(qvel, qvel + kQvel + (rolls() ? 2 : 0), 0);
  qpos[0] = robot.place_m.x();
  qpos[1] = robot.place_m.y();
  qpos[2] = rolls() ? kWheelRadius_m : kHoverHeight_m;
  qpos[3] = std::cos(heading_rad / 2);
  qpos[4] = qpos[5] = 0;
  qpos[6] = std::sin(heading_rad / 2);
  std::copy(robot.velocity_mps.data(), robot.velocity_mps.data() + 2, qvel);
  const double act = rolls() ? robot.velocity_mps.norm() / kWheelRadius_m
                             : kQuadrotorMass_kg * -model_->opt.gravity[2] / 4;
  std::fill_n(data_->act + robot.act_at, rolls() ? 2 : 4, act);
  if (rolls()) qvel[kQvel] = qvel[kQvel + 1] = act;
}

RobotState MujocoPhysics::state_of(const Robot& robot) const {
  RobotState state;
  const double* const qpos = data_->qpos + robot.qpos_at;
  const double* const qvel = data_->qvel + robot.dof_at;
  double matrix[9];
  mju_quat2Mat(matrix, qpos + 3);
  state.position_m = Eigen::Map<const Eigen::Vector3d>(qpos);
  state.velocity_mps = Eigen::Map<const Eigen::Vector3d>(qvel);
  state.attitude = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(matrix);
  state.turning_radps = Eigen::Map<const Eigen::Vector3d>(qvel + 3);
  return state;
}

void MujocoPhysics::steer(Robot& robot, const Eigen::Vector3d& wanted_mps) {
  RobotState state = state_of(robot);
  state.position_m.z() -= robot.held_m - kHoverHeight_m;  // its pilot holds kHoverHeight_m
  double* const control = data_->ctrl + robot.act_at;
  if (rolls()) {
    const auto speeds =
        robot.wheels_radps ? *robot.wheels_radps : robot.disc.wheels_radps(state, wanted_mps);
    std::copy(speeds.begin(), speeds.end(), control);
  } else {
    const auto thrusts = robot.quadrotor.thrusts_n(state, wanted_mps);
    std::copy(thrusts.begin(), thrusts.end(), control);
  }
}

void MujocoPhysics::note_contacts() {
  for (int i = 0; i < data_->ncon; ++i) {
    const mjContact& contact = data_->contact[i];
    const AgentId one = owner_[static_cast<std::size_t>(contact.geom1)];
    const AgentId other = owner_[static_cast<std::size_t>(contact.geom2)];
    const auto [first, second] = std::minmax(one, other);
    if (first != kNobody && second >= 0) touching_.insert({first, second});
  }
}

std::string MujocoPhysics::summary() const {
  return std::to_string(contacts_.robots) + " contacts of two robots, " +
         std::to_string(contacts_.walls) + " of a robot and a wall";
}

PhysicsMaker mujoco_physics(const RobotDesign& design, MujocoPhysics** made) {
  return [=](const Mission& mission) -> Result<std::unique_ptr<Physics>> {
    if (!mission.domain.planar())
      return failure(
          "the mission is in space, and these robots move in a plane: remove domain.size_z_m");
    if (any_but_points(mission))
      return failure(
          "the mission is for other vehicles: give it vehicle { kind: POINT } and "
          "separation.response_s");
    const double distance_m = mission.separation.distance_m;
    if (distance_m > 0 && distance_m < 2 * design.radius_m)
      return failure(
          "separation.distance_m is less than a robot's diameter: robots that keep it touch");
    if (!mission.walls.empty() && mission.wall_clearance_m < design.radius_m)
      return failure(
          "world.wall_clearance_m is less than a robot's radius: robots that keep it touch "
          "walls");
    if (mission.starts_m.size() > kMostRobots)
      return failure("the mission has more than " + std::to_string(kMostRobots) +
                     " robots: use fewer");
    auto physics = std::make_unique<MujocoPhysics>(mission, design);
    if (made != nullptr) *made = physics.get();
    return physics;
  };
}

}  // namespace ergocast::mujoco
