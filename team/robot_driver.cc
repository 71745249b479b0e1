// SPDX-License-Identifier: BSD-3-Clause
// Publishes the robots' positions at each tick, passes commands to them, and stops robots that get
// none.
#include "team/robot_driver.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/motion/filter_rules.h"
#include "core/motion/vehicle.h"
#include "core/motion/zones.h"

namespace ergocast {
namespace {

/// How long a driver listens for another driver of the same robot.
constexpr std::chrono::nanoseconds kListening = std::chrono::seconds(1);
/// How many commands are remembered, until positions that were measured after them arrive.
constexpr std::size_t kMostAnswers = 256;
/// How many states follow a STOP at once, because some may be lost.
constexpr int kLastStates = 5;

}  // namespace

RobotDriver::RobotDriver(RunId run, Incarnation incarnation, const std::vector<AgentId>& robots)
    : me_(kRole, {run, kWorld, incarnation}), has_all_(robots.empty()) {
  for (const AgentId id : robots) slots_[id];
}

void RobotDriver::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  if (stopped_) return;
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
}

void RobotDriver::on(const Stop& over, const Arrival&) {
  if (!over.now || me_.run() == 0) return;  // if in order, the coordinator ends the mission
  if (running_) last_states_ = kLastStates;
  next_tick_ = {};
  stop(over.reason);
}

void RobotDriver::on(const MissionPart& part, const Arrival& arrival) {
  if (running_ && !has_all_) catch_up(part.header.tick);
  if (!arrival.mission_changed) return;
  if (follower().over()) return stop(follower().reason());
  if (follower().plan_problem()) return fail(*follower().plan_problem());
  if (const auto why = why_not_any(me_.mission())) return fail(*why);
  take_roster();
  take_zones();
  if (running_ || follower().state() != MissionState::kRunning) return;
  begin_mission(part.header.tick, arrival.now);
}

/// The reason why it cannot take part.
std::optional<std::string> RobotDriver::why_not_any(const Mission& mission) const {
  if (mission.timing.pace == Pace::kLockstep)
    return "the mission is in lockstep, which robots cannot be: give it pace: REALTIME";
  if (!has_all_ && keeps_distance(mission) && !uses_beacons(mission))
    return "a driver of one robot does not know where the others are: give the mission separation "
           "{ lease_s }, so that agents send each other their positions";
  return why_not(mission);
}

void RobotDriver::begin_mission(Tick tick, Instant now) {
  running_ = true;
  if (filters_again(me_.mission()) && !guard_) guard_.emplace(me_.mission(), 0);
  tick_ = tick;
  next_tick_ = has_all_ ? now : now + kListening;
  begun_ = next_tick_;
  begin(me_.mission());
}

bool RobotDriver::is_exact() const { return guard_ || keeps_distance(me_.mission()); }

/// Another driver may be one tick ahead, because it started at another moment. A larger difference
/// means that our ticks were late.
void RobotDriver::catch_up(Tick team_tick) {
  if (team_tick <= tick_ + 1) return;
  skipped_ticks_ += team_tick - tick_;
  tick_ = std::min(team_tick, me_.end_tick());
}

/// The agents' present incarnations may command their robots.
void RobotDriver::take_roster() {
  std::map<AgentId, Author> members;
  for (const RosterEntry& entry : follower().roster()) {
    if (entry.active_until < 0) members[entry.author.agent] = entry.author;
  }
  for (const auto& [id, author] : members) {
    if (has_all_ && slots_.try_emplace(id).second) join(me_.mission(), id);
  }
  for (auto& [id, slot] : slots_) {
    const auto member = members.find(id);
    const Author author = member == members.end() ? Author{} : member->second;
    if (author != slot.author) slot.answers.clear();
    if (author.incarnation == 0) order(id, slot, {0, 0, 0});
    slot.author = author;
  }
}

/// Once a zone was announced, the commands are filtered again.
void RobotDriver::take_zones() {
  const std::vector<Zone>& zones = follower().amendments().zones;
  if (zones == zones_) return;
  zones_ = zones;
  if (!guard_) guard_.emplace(me_.mission(), 0);
  guard_->set_zones(zones_);
}

/// A driver that already drives the robot continues. If two began together, the one with the
/// greater identity stops. Later no driver stops, because the other one may be a recording.
void RobotDriver::on(const WorldState& other, const Arrival& arrival) {
  const bool begins = !running_ || arrival.now < begun_ + kListening;
  if (!arrival.fresh || !begins) return;
  if (published_ && other.header.incarnation > me_.incarnation()) return;
  for (const Vehicle& vehicle : other.vehicles_in_part()) {
    if (has_all_ || slots_.contains(vehicle.id))
      return fail("robot " + std::to_string(vehicle.id) +
                  " is driven by another driver already: end that one first, or drive another "
                  "robot");
  }
}

void RobotDriver::on(const Command& command, const Arrival& arrival) {
  const auto at = slots_.find(command.header.sender);
  if (at == slots_.end() || at->second.author.incarnation != command.header.incarnation) return;
  auto& [id, slot] = *at;
  const Tick last = slot.answered();
  // An agent may replace its command of a tick only by a stop.
  if (command.header.tick == last && command.velocity_mps.isZero(0)) order(id, slot, {0, 0, 0});
  if (command.header.tick > tick_ || command.header.tick <= last) return;
  slot.answers.push_back({command.header.tick, arrival.now});
  if (slot.answers.size() > kMostAnswers) slot.answers.pop_front();
  const Timing& timing = me_.timing();
  const double age_s = static_cast<double>(tick_ - command.header.tick) * timing.dt_s;
  if (age_s > timing.command_hold_s) return order(id, slot, {0, 0, 0});
  const Eigen::Vector3d allowed_mps =
      within_speed_limit(motion_of(me_.mission(), id), command.velocity_mps);
  if (allowed_mps != command.velocity_mps) ++clamped_commands_;
  order(id, slot, allowed_mps);
  if (!sees_all()) steer(id, slot, {}, arrival.now);  // else at the tick, with all positions
}

void RobotDriver::order(AgentId id, Slot& slot, const Eigen::Vector3d& velocity_mps) {
  slot.commanded_mps = velocity_mps;
  if (velocity_mps.isZero(0)) go(id, velocity_mps);
}

void RobotDriver::steer(AgentId id, const Slot& slot, std::span<const Neighbour> bodies,
                        Instant now) {
  const auto fix = fix_of(id, now);
  if (slot.commanded_mps.isZero(0) || !fix) return go(id, {0, 0, 0});
  if (!guard_) return go(id, slot.commanded_mps);
  const Mission& mission = me_.mission();
  const double limit_mps = motion_of(mission, id).speed_limit_mps;
  Mover self{id, tick_, fix->position_m, limit_or_speed_mps(limit_mps, slot.commanded_mps),
             fix->velocity_mps};
  if (mission.domain.planar()) self.position_m.z() = mission.domain.origin_m.z();
  go(id, guard_->safe(self, slot.commanded_mps, bodies).velocity_mps);
}

/// All robots, for a driver that has all of them.
std::vector<Neighbour> RobotDriver::bodies(Instant now) const {
  std::vector<Neighbour> bodies;
  if (!sees_all()) return bodies;
  for (const auto& [id, slot] : slots_) {
    if (const auto fix = fix_of(id, now))
      bodies.push_back({id, fix->position_m, motion_of(me_.mission(), id).speed_limit_mps, 0, true,
                        fix->velocity_mps});
  }
  return bodies;
}

void RobotDriver::advance(Instant now, Outbox& out) {
  if (!ticks() || now < next_tick_) return;
  const Timing& timing = me_.timing();
  if (stopped_) {
    move(me_.mission());
    ++tick_;
    if (have_stopped()) --last_states_;
  } else if (published_ && !me_.is_over(tick_)) {
    pass_tick(now);
  }
  if (me_.is_over(tick_)) stop_all();  // until the coordinator has ended the mission
  publish(now, out);
  published_ = true;
  // Missed ticks are not repeated.
  next_tick_ = std::max(next_tick_ + seconds(timing.dt_s / timing.realtime_factor), now);
}

/// A robot never moves for long without a command.
void RobotDriver::pass_tick(Instant now) {
  const Timing& timing = me_.timing();
  for (auto& [id, slot] : slots_) {
    const double age_s = static_cast<double>(tick_ - slot.answered()) * timing.dt_s;
    const bool driven = slot.author.incarnation != 0;
    if (driven && slot.answered() < tick_) ++missed_deadlines_;
    if (!driven || age_s > timing.command_hold_s) order(id, slot, {0, 0, 0});
  }
  const std::vector<Neighbour> all = bodies(now);
  for (const auto& [id, slot] : slots_) steer(id, slot, all, now);
  move(me_.mission());
  ++tick_;
}

void RobotDriver::stop_all() {
  for (auto& [id, slot] : slots_) order(id, slot, {0, 0, 0});
}

WorldState RobotDriver::empty_state() const {
  WorldState state;
  state.roster_revision = follower().revision();
  state.missed_deadlines = missed_deadlines_;
  state.clamped_commands = clamped_commands_;
  state.skipped_ticks = skipped_ticks_;
  state.uncounted_ticks = tick_ - me_.counted(tick_);
  return state;
}

void RobotDriver::add(AgentId id, const Slot& slot, const RobotFix& fix, WorldState& state) const {
  const Box& domain = me_.mission().domain;
  Vehicle& vehicle = state.add_vehicle();
  vehicle.id = id;
  const auto after = std::ranges::find_if(
      slot.answers, [&](const Answered& one) { return one.arrived > fix.not_before; });
  vehicle.answered_tick = after == slot.answers.begin() ? -1 : std::prev(after)->tick;
  vehicle.position_m = fix.position_m;
  vehicle.velocity_mps = fix.velocity_mps;
  vehicle.charge_ppm = fix.charge_ppm;
  if (slot.commanded_mps.isZero(0) && fix.stands) vehicle.velocity_mps.setZero();
  if (domain.planar()) {
    vehicle.position_m.z() = domain.origin_m.z();
    vehicle.velocity_mps.z() = 0;
  }
  // Agents refuse a position outside the domain. But agents that keep distances need the true one.
  if (!keeps_distance(me_.mission())) vehicle.position_m = domain.nearest(vehicle.position_m);
}

/// A driver of all robots fills one state after the other. Else each robot is a part of its own,
/// so that several drivers' parts make one state.
void RobotDriver::publish(Instant now, Outbox& out) {
  auto robots = static_cast<std::int32_t>(me_.mission().starts_m.size());
  for (const RosterEntry& entry : follower().roster())
    robots = std::max(robots, entry.author.agent + 1);
  for (const auto& [id, slot] : slots_) robots = std::max(robots, id + 1);
  const auto each = static_cast<std::size_t>(has_all_ ? kMaxVehiclesPerState : 1);
  const auto parts = static_cast<std::int32_t>((slots_.size() + each - 1) / each);
  std::int32_t part = 0;
  for (auto at = slots_.begin(); at != slots_.end(); ++part) {
    WorldState state = empty_state();
    state.part = has_all_ ? part : at->first;
    state.parts = has_all_ ? parts : robots;
    for (std::size_t i = 0; i < each && at != slots_.end(); ++i, ++at) {
      if (const auto fix = fix_of(at->first, now)) add(at->first, at->second, *fix, state);
    }
    if (state.vehicle_count > 0) me_.publish(Bus::kWorld, state, tick_, out);
  }
}

void RobotDriver::stop(std::string reason) {
  if (stopped_) return;
  stopped_ = true;
  reason_ = std::move(reason);
  stop_all();
  finish();
}

void RobotDriver::fail(std::string reason) {
  if (failed_) return;
  failed_ = true;
  stop(std::move(reason));
}

}  // namespace ergocast
