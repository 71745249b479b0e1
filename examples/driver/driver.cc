// SPDX-License-Identifier: BSD-3-Clause
// Publishes the robots' positions at each tick, passes commands to them, and stops robots that get
// none.
#include "examples/driver/driver.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/motion/filter_rules.h"
#include "core/motion/starts.h"
#include "core/motion/zones.h"

namespace ergocast::example {
namespace {

/// How long the driver of one robot listens for another driver of that robot.
constexpr std::chrono::nanoseconds kListening = std::chrono::seconds(1);

void halt_robot(auto& slot) {
  slot.commanded_mps.setZero();
  slot.robot.drive({0, 0, 0});
}

}  // namespace

Driver::Driver(RunId run, Incarnation incarnation, double speed_limit_mps,
               std::optional<AgentId> only)
    : me_(kRole, {run, kWorld, incarnation}), speed_limit_mps_(speed_limit_mps), only_(only) {}

void Driver::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  if (finished_) return;
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
}

void Driver::on(const Stop& over, const Arrival&) {
  if (!over.now || me_.run() == 0) return;  // if in order, the coordinator ends the mission
  stop(over.reason);
  emergency_stopped_ = running_;
}

void Driver::on(const MissionPart& part, const Arrival& arrival) {
  if (running_ && only_) catch_up(part.header.tick);
  if (!arrival.mission_changed) return;
  if (follower().over()) return stop(follower().reason());
  if (const auto why = why_not()) {
    failed_ = true;
    return stop(*why);
  }
  take_roster();
  take_zones();
  if (running_ || follower().state() != MissionState::kRunning) return;
  running_ = true;
  if (filters_again(me_.mission()) && !guard_) guard_.emplace(me_.mission(), 0);
  tick_ = part.header.tick;
  begun_ = next_tick_ = arrival.now + (only_ ? kListening : std::chrono::nanoseconds(0));
}

/// The reason why it cannot take part.
std::optional<std::string> Driver::why_not() const {
  if (follower().plan_problem()) return follower().plan_problem();
  const Mission& mission = me_.mission();
  if (mission.timing.pace == Pace::kLockstep)
    return "the mission is in lockstep, which robots cannot be: give it pace: REALTIME";
  if (!has_vehicles_for(mission))
    return "the mission is for other vehicles: give it vehicle { kind: POINT }, or UNICYCLE and at "
           "most the robots' 2 rad/s";
  if (only_ && keeps_distance(mission) && !uses_beacons(mission))
    return "a driver of one robot does not know where the others are: give the mission separation "
           "{ lease_s }, so that agents send each other their positions, or drive all robots "
           "without --id";
  return std::nullopt;
}

/// Once a zone was announced, the robots' commands are filtered again.
void Driver::take_zones() {
  const std::vector<Zone>& zones = follower().amendments().zones;
  if (zones == zones_) return;
  zones_ = zones;
  if (!guard_) guard_.emplace(me_.mission(), 0);
  guard_->set_zones(zones_);
}

/// Another driver may be one tick ahead, because it started at another moment. A larger difference
/// means that our ticks were late.
void Driver::catch_up(Tick team_tick) {
  if (team_tick <= tick_ + 1) return;
  skipped_ticks_ += team_tick - tick_;
  tick_ = std::min(team_tick, me_.end_tick());
}

/// A driver that already drives the robot continues. If two began together, the one with the
/// greater identity stops. Later no driver stops, because the other one may be a recording.
void Driver::on(const WorldState& other, const Arrival& arrival) {
  const bool begins = !running_ || arrival.now < begun_ + kListening;
  if (!arrival.fresh || !begins) return;
  if (published_ && other.header.incarnation > me_.incarnation()) return;
  for (const Vehicle& vehicle : other.vehicles_in_part()) {
    if (only_ && vehicle.id != *only_) continue;
    failed_ = true;
    return stop("robot " + std::to_string(vehicle.id) +
                " is driven by another driver already: end that one first, or choose " +
                (only_ ? "another --id" : "one robot by --id"));
  }
}

/// Whether the robots can move as all kinds of agents expect.
bool Driver::has_vehicles_for(const Mission& mission) {
  bool all = true;
  for (int kind = 0; kind < std::max<int>(1, static_cast<int>(mission.kinds.size())); ++kind) {
    const Motion motion = motion_of_kind(mission, kind);
    all = all && (motion.is_point() || (drives_unicycle(motion) &&
                                        motion.vehicle.max_turn_radps <= Robot::kTurnLimit_radps));
  }
  return all;
}

/// Every member gets a robot. Here they are made at the plan's starts; real robots already stand
/// somewhere.
void Driver::take_roster() {
  std::map<AgentId, Author> members;
  for (const RosterEntry& entry : follower().roster()) {
    const bool ours = !only_ || entry.author.agent == *only_;
    if (ours && entry.active_until < 0) members[entry.author.agent] = entry.author;
  }
  for (auto& [id, drive] : drives_) {
    if (!members.contains(id)) drive.author = {};
  }
  for (const auto& [id, author] : members) {
    const Robot robot(start_of(me_.mission(), id), speed_limit_mps_);
    VehicleSlot& drive = drives_.try_emplace(id, VehicleSlot{author, robot}).first->second;
    if (drive.author != author) drive.answered = -1;
    drive.author = author;
  }
}

void Driver::on(const Command& command, const Arrival&) {
  const auto at = drives_.find(command.header.sender);
  if (at == drives_.end() || at->second.author.incarnation != command.header.incarnation) return;
  VehicleSlot& drive = at->second;
  // An agent may replace its command of a tick only by a stop.
  const bool halt = command.header.tick == drive.answered && command.velocity_mps.isZero(0);
  if (halt) halt_robot(drive);
  if (command.header.tick > tick_ || command.header.tick <= drive.answered) return;
  drive.answered = command.header.tick;
  const Timing& timing = me_.mission().timing;
  const double age_s = static_cast<double>(tick_ - drive.answered) * timing.dt_s;
  if (age_s > timing.command_hold_s) return halt_robot(drive);
  const Eigen::Vector3d allowed_mps =
      within_speed_limit(motion_of(me_.mission(), command.header.sender), command.velocity_mps);
  if (allowed_mps != command.velocity_mps) ++clamped_commands_;
  drive.commanded_mps = allowed_mps;
  // If distances are kept, only the commanded direction is safe.
  if (!guard_) drive.robot.drive(allowed_mps, keeps_distance(me_.mission()));
}

/// Runs once a tick with all positions, because the motion of one robot may depend on the others.
void Driver::hold_apart() {
  const auto limit_of = [&](AgentId id) { return motion_of(me_.mission(), id).speed_limit_mps; };
  std::vector<Neighbour> bodies;
  for (const auto& [id, drive] : drives_)
    bodies.push_back(
        {id, drive.robot.position_m(), limit_of(id), 0, true, drive.robot.velocity_mps()});
  for (auto& [id, drive] : drives_) {
    const double limit_mps = limit_or_speed_mps(limit_of(id), drive.commanded_mps);
    const Mover self{id, tick_, drive.robot.position_m(), limit_mps, drive.robot.velocity_mps()};
    const bool stands = drive.commanded_mps.isZero(0);
    drive.robot.drive(
        stands ? drive.commanded_mps : guard_->safe(self, drive.commanded_mps, bodies).velocity_mps,
        true);
  }
}

void Driver::advance(Instant now, Outbox& out) {
  if (emergency_stopped_) {  // the last state: no robot moves any more
    emergency_stopped_ = false;
    pass_tick();
    return publish_position(out);
  }
  if (!running_ || finished_ || now < next_tick_) return;
  const Timing& timing = me_.mission().timing;
  if (published_ && !me_.is_over(tick_)) pass_tick();
  publish_position(out);
  published_ = true;
  // At the end the last state is repeated until the coordinator has ended the mission.
  const auto period = seconds(timing.dt_s / timing.realtime_factor);
  next_tick_ = std::max(next_tick_ + period, now);  // missed ticks are not repeated
}

/// A robot never moves for long without a command.
void Driver::pass_tick() {
  const Timing& timing = me_.mission().timing;
  for (auto& [id, drive] : drives_) {
    const bool driven = drive.author.incarnation != 0;
    const double age_s = static_cast<double>(tick_ - drive.answered) * timing.dt_s;
    if (driven && drive.answered < tick_) ++missed_deadlines_;
    if (finished_ || !driven || age_s > timing.command_hold_s) halt_robot(drive);
  }
  if (guard_) hold_apart();
  for (auto& [id, drive] : drives_) {
    if (const Motion motion = motion_of(me_.mission(), id); drives_unicycle(motion)) {
      drive.robot.move_as_unicycle(motion);
    } else {
      drive.robot.move(timing.dt_s);
    }
  }
  ++tick_;
}

void Driver::publish_position(Outbox& out) {
  const Box& domain = me_.mission().domain;
  const bool apart = keeps_distance(me_.mission());
  const auto parts = (drives_.size() + kMaxVehiclesPerState - 1) / kMaxVehiclesPerState;
  // Each robot's driver sends one part of the state.
  auto robots = static_cast<std::int32_t>(me_.mission().starts_m.size());
  for (const RosterEntry& entry : follower().roster())
    robots = std::max(robots, entry.author.agent + 1);
  auto drive = drives_.begin();
  for (std::size_t part = 0; part < parts; ++part) {
    WorldState state;
    state.roster_revision = follower().revision();
    state.missed_deadlines = missed_deadlines_;
    state.clamped_commands = clamped_commands_;
    state.uncounted_ticks = tick_ - me_.counted(tick_);
    state.part = only_.value_or(static_cast<std::int32_t>(part));
    state.parts = only_ ? robots : static_cast<std::int32_t>(parts);
    state.skipped_ticks = skipped_ticks_;
    for (; drive != drives_.end() && state.vehicle_count < kMaxVehiclesPerState; ++drive) {
      Vehicle& vehicle = state.add_vehicle();
      const auto& [id, one] = *drive;
      vehicle.id = id;
      vehicle.answered_tick = one.answered;
      // Agents refuse a position outside the domain. But agents that keep distances need the true
      // position.
      vehicle.position_m = apart ? one.robot.position_m() : domain.nearest(one.robot.position_m());
      vehicle.velocity_mps = one.robot.velocity_mps();
    }
    me_.publish(Bus::kWorld, state, tick_, out);
  }
}

void Driver::stop(std::string reason) {
  finished_ = true;
  reason_ = std::move(reason);
  for (auto& [id, drive] : drives_) halt_robot(drive);
}

}  // namespace ergocast::example
