// SPDX-License-Identifier: BSD-3-Clause
// Follows the rules of a driver, as examples/driver does, with positions that may be missing.
#include "bridges/ros2/driver.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/motion/filter_rules.h"
#include "core/motion/vehicle.h"

namespace ergocast::ros2 {
namespace {

/// How long it listens for another driver of the same robot.
constexpr std::chrono::nanoseconds kListening = std::chrono::seconds(1);
/// How many commands are remembered, until positions that were measured after them arrive.
constexpr std::size_t kMostAnswers = 256;

}  // namespace

Driver::Driver(RunId run, Incarnation incarnation, std::map<AgentId, Robot> robots)
    : me_(kRole, {run, kWorld, incarnation}) {
  for (auto& [id, robot] : robots) slots_.emplace(id, Slot{std::move(robot)});
}

void Driver::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  if (stopped_) return;
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
}

void Driver::on(const Stop& over, const Arrival&) {
  if (!over.now || me_.run() == 0) return;  // if in order, the coordinator ends the mission
  sends_until_it_stands_ = running_;
  next_tick_ = {};
  stop(over.reason);
}

void Driver::on(const MissionPart& part, const Arrival& arrival) {
  // Another driver may be a tick ahead. A larger difference means that our ticks were late.
  if (running_ && part.header.tick > tick_ + 1) {
    skipped_ticks_ += part.header.tick - tick_;
    tick_ = std::min(part.header.tick, me_.end_tick());
  }
  if (!arrival.mission_changed) return;
  if (follower().over()) return stop(follower().reason());
  if (const auto why = why_not()) return fail(*why);
  take_roster();
  take_zones();
  if (running_ || follower().state() != MissionState::kRunning) return;
  begin(part.header.tick, arrival.now);
}

void Driver::begin(Tick tick, Instant now) {
  running_ = true;
  const Mission& mission = me_.mission();
  if (filters_again(mission) && !guard_) guard_.emplace(mission, 0);
  tick_ = tick;
  begun_ = now;
  next_tick_ = now + kListening;
  // The separation assumes that a robot follows a command at most so late after its position.
  const double oldest_fix_s = mission.separation.response_s + mission.timing.dt_s;
  const bool apart = keeps_distance(mission);
  for (auto& [id, slot] : slots_)
    slot.robot.begin(mission.domain, apart ? oldest_fix_s : kOldestFix_s,
                     apart || guard_.has_value());
}

/// The reason why it cannot take part.
std::optional<std::string> Driver::why_not() const {
  if (follower().plan_problem()) return follower().plan_problem();
  const Mission& mission = me_.mission();
  if (mission.timing.pace == Pace::kLockstep)
    return "the mission is in lockstep, which robots cannot be: give it pace: REALTIME";
  if (mission.timing.realtime_factor != 1)
    return "the mission's seconds are not those of the clock: leave out realtime_factor";
  if (keeps_distance(mission) && !uses_beacons(mission))
    return "the positions of some robots may be missing: give the mission separation { lease_s }, "
           "so that agents send each other their positions";
  for (const auto& [id, slot] : slots_) {
    if (auto why = why_not(id, slot.robot)) return why;
  }
  return std::nullopt;
}

std::optional<std::string> Driver::why_not(AgentId id, const Robot& robot) const {
  const Mission& mission = me_.mission();
  const std::string name = "robot " + std::to_string(id);
  if (!motion_of(mission, id).is_point())
    return name +
           " follows velocities of points: give the mission vehicle { kind: POINT }, and "
           "separation { response_s } for how late robots follow";
  if (!mission.domain.planar() && robot.limits().kind == DriveKind::kDifferential)
    return name + " cannot climb, and the mission is in a box: leave out size_z_m";
  return std::nullopt;
}

/// The agents' present incarnations may command their robots.
void Driver::take_roster() {
  for (auto& [id, slot] : slots_) {
    Author author;
    for (const RosterEntry& entry : follower().roster()) {
      if (entry.author.agent == id && entry.active_until < 0) author = entry.author;
    }
    if (author != slot.author) slot.answers.clear();
    if (author.incarnation == 0) order(slot, {0, 0, 0});
    slot.author = author;
  }
}

/// Once a zone was announced, the commands are filtered again.
void Driver::take_zones() {
  const std::vector<Zone>& zones = follower().amendments().zones;
  if (zones == zones_) return;
  zones_ = zones;
  if (!guard_) guard_.emplace(me_.mission(), 0);
  guard_->set_zones(zones_);
}

/// The driver that already drives a robot continues. If two began together, the one with the
/// greater identity stops.
void Driver::on(const WorldState& other, const Arrival& arrival) {
  const bool begins = !running_ || arrival.now < begun_ + kListening;
  if (!arrival.fresh || !begins) return;
  if (published_ && other.header.incarnation > me_.author().incarnation) return;
  for (const Vehicle& vehicle : other.vehicles_in_part()) {
    if (slots_.contains(vehicle.id))
      return fail("robot " + std::to_string(vehicle.id) +
                  " is driven by another driver already: end that one first, or choose other "
                  "robots by --robot");
  }
}

void Driver::on(const Command& command, const Arrival& arrival) {
  const auto at = slots_.find(command.header.sender);
  if (at == slots_.end() || at->second.author.incarnation != command.header.incarnation) return;
  Slot& slot = at->second;
  const Tick last = slot.answered();
  // An agent may replace its command of a tick only by a stop.
  if (command.header.tick == last && command.velocity_mps.isZero(0)) order(slot, {0, 0, 0});
  if (command.header.tick > tick_ || command.header.tick <= last) return;
  slot.answers.push_back({command.header.tick, arrival.now});
  if (slot.answers.size() > kMostAnswers) slot.answers.pop_front();
  const Timing& timing = me_.mission().timing;
  const double age_s = static_cast<double>(tick_ - command.header.tick) * timing.dt_s;
  if (age_s > timing.command_hold_s) return order(slot, {0, 0, 0});
  const Eigen::Vector3d allowed_mps =
      within_speed_limit(motion_of(me_.mission(), at->first), command.velocity_mps);
  if (allowed_mps != command.velocity_mps) ++clamped_commands_;
  order(slot, allowed_mps);
  steer(at->first, slot, arrival.now);
}

void Driver::order(Slot& slot, const Eigen::Vector3d& velocity_mps) {
  slot.commanded_mps = velocity_mps;
  if (velocity_mps.isZero(0)) slot.robot.go(velocity_mps);
}

/// Walls and zones shorten the step; other robots are the agent's.
void Driver::steer(AgentId id, Slot& slot, Instant now) {
  const auto fix = slot.robot.fix(now);
  if (slot.commanded_mps.isZero(0) || !fix) return slot.robot.go({0, 0, 0});
  if (!guard_) return slot.robot.go(slot.commanded_mps);
  const double limit_mps = motion_of(me_.mission(), id).speed_limit_mps;
  Mover self{id, tick_, fix->position_m, limit_or_speed_mps(limit_mps, slot.commanded_mps),
             fix->velocity_mps};
  if (me_.mission().domain.planar()) self.position_m.z() = me_.mission().domain.origin_m.z();
  slot.robot.go(guard_->safe(self, slot.commanded_mps, {}).velocity_mps);
}

bool Driver::has_standing_robots() const {
  return std::ranges::all_of(slots_, [](const auto& one) { return one.second.robot.done(); });
}

bool Driver::finished() const {
  return stopped_ && has_standing_robots() && (!sends_until_it_stands_ || last_states_ <= 0);
}

void Driver::advance(Instant now, Outbox& out) {
  if (running_ && now >= next_tick_ && (!stopped_ || sends_until_it_stands_)) {
    if (stopped_) {
      ++tick_;
      if (has_standing_robots()) --last_states_;
    } else if (published_ && !me_.is_over(tick_)) {
      pass_tick(now);
    }
    if (me_.is_over(tick_)) {  // until the coordinator has ended the mission
      for (auto& [id, slot] : slots_) order(slot, {0, 0, 0});
    }
    publish(now, out);
    published_ = true;
    // Missed ticks are not repeated.
    next_tick_ = std::max(next_tick_ + seconds(me_.mission().timing.dt_s), now);
  }
  for (auto& [id, slot] : slots_) slot.robot.note_change(now);
}

Instant Driver::next_wakeup() const {
  Instant next = Instant::max();
  if (running_ && (!stopped_ || sends_until_it_stands_)) next = next_tick_;
  for (const auto& [id, slot] : slots_) next = std::min(next, slot.robot.next_wakeup());
  return next;
}

/// A robot never moves for long without a command.
void Driver::pass_tick(Instant now) {
  const Timing& timing = me_.mission().timing;
  for (auto& [id, slot] : slots_) {
    const double age_s = static_cast<double>(tick_ - slot.answered()) * timing.dt_s;
    const bool driven = slot.author.incarnation != 0;
    if (driven && slot.answered() < tick_) ++missed_deadlines_;
    if (!driven || age_s > timing.command_hold_s) order(slot, {0, 0, 0});
    steer(id, slot, now);
  }
  ++tick_;
}

WorldState Driver::state_of(AgentId id, const Slot& slot, const Fix& fix, Instant now) const {
  const Mission& mission = me_.mission();
  WorldState state;
  state.roster_revision = follower().revision();
  state.missed_deadlines = missed_deadlines_;
  state.clamped_commands = clamped_commands_;
  state.skipped_ticks = skipped_ticks_;
  state.uncounted_ticks = tick_ - me_.counted(tick_);
  state.part = id;
  state.parts = std::max(id + 1, static_cast<std::int32_t>(mission.starts_m.size()));
  for (const RosterEntry& entry : follower().roster())
    state.parts = std::max(state.parts, entry.author.agent + 1);
  Vehicle& vehicle = state.add_vehicle();
  vehicle.id = id;
  // The newest command that had arrived when the position was measured.
  const auto after = std::ranges::find_if(
      slot.answers, [&](const Answered& one) { return one.arrived > fix.measured; });
  vehicle.answered_tick = after == slot.answers.begin() ? -1 : std::prev(after)->tick;
  vehicle.position_m = fix.position_m;
  vehicle.velocity_mps = fix.velocity_mps;
  if (slot.commanded_mps.isZero(0) && slot.robot.stands(now)) vehicle.velocity_mps.setZero();
  if (mission.domain.planar()) {
    vehicle.position_m.z() = mission.domain.origin_m.z();
    vehicle.velocity_mps.z() = 0;
  }
  // Agents refuse a position outside the domain. But agents that keep distances need the true one.
  if (!keeps_distance(mission)) vehicle.position_m = mission.domain.nearest(vehicle.position_m);
  return state;
}

void Driver::publish(Instant now, Outbox& out) {
  for (const auto& [id, slot] : slots_) {
    if (const auto fix = slot.robot.fix(now))
      me_.publish(Bus::kWorld, state_of(id, slot, *fix, now), tick_, out);
  }
}

void Driver::stop(std::string reason) {
  if (stopped_) return;
  stopped_ = true;
  reason_ = std::move(reason);
  for (auto& [id, slot] : slots_) {
    order(slot, {0, 0, 0});
    slot.robot.finish();
  }
}

void Driver::fail(std::string reason) {
  if (failed_) return;
  failed_ = true;
  stop(std::move(reason));
}

}  // namespace ergocast::ros2
