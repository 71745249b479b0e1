// SPDX-License-Identifier: BSD-3-Clause
// Follows the rules of a driver of one robot, as examples/driver does.
#include "bridges/mavlink/driver.h"

#include <ergocast/core/motion/filter_rules.h>
#include <ergocast/core/motion/vehicle.h>

#include <algorithm>
#include <utility>

namespace ergocast::mavlink {
namespace {

/// How long it listens for another driver of the same agent.
constexpr std::chrono::nanoseconds kOtherDriver = std::chrono::seconds(1);
/// How many commands are remembered, until positions that were measured after them arrive.
constexpr std::size_t kMostAnswers = 256;

}  // namespace

Driver::Driver(RunId run, Incarnation incarnation, AgentId id, const VehicleOptions& options)
    : me_(kRole, {run, kWorld, incarnation}),
      id_(id),
      vehicle_(options, static_cast<std::uint32_t>(incarnation)) {}

void Driver::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  if (stopped_) return;
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
}

void Driver::on(const Stop& over, const Arrival&) {
  if (!over.now || me_.run() == 0) return;  // if in order, the coordinator ends the mission
  tells_until_it_stands_ = running_;
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
  if (me_.follower().over()) return stop(me_.follower().reason());
  if (const auto why = why_not()) return fail(*why);
  take_roster();
  take_zones();
  if (running_ || me_.follower().state() != MissionState::kRunning) return;
  begin(part.header.tick, arrival.now);
}

void Driver::begin(Tick tick, Instant now) {
  running_ = true;
  const Mission& mission = me_.mission();
  if (filters_again(mission) && !guard_) guard_.emplace(mission, 0);
  tick_ = tick;
  begun_ = now;
  next_tick_ = now + kOtherDriver;
  const double limit_mps = motion_of(mission, id_).speed_limit_mps;
  // The separation assumes that a vehicle follows a command at most so late after its position.
  const double oldest_fix_s = mission.separation.response_s + mission.timing.dt_s;
  vehicle_.begin(mission.domain, limit_mps > 0 ? limit_mps : mission.law.u_max_mps,
                 keeps_distance(mission) ? oldest_fix_s : kOldestFix_s, mission.walls);
}

/// The reason why it cannot take part.
std::optional<std::string> Driver::why_not() const {
  if (me_.follower().plan_problem()) return me_.follower().plan_problem();
  const Mission& mission = me_.mission();
  if (mission.timing.pace == Pace::kLockstep)
    return "the mission is in lockstep, which vehicles cannot be: give it pace: REALTIME";
  if (mission.timing.realtime_factor != 1)
    return "the mission's seconds are not those of the clock: leave out realtime_factor";
  if (!motion_of(mission, id_).is_point())
    return "the mission is for other vehicles: give it vehicle { kind: POINT }, and "
           "separation { response_s } for how late they follow";
  if (keeps_distance(mission) && !uses_beacons(mission))
    return "a driver of one vehicle does not know where the others are: give the mission "
           "separation { lease_s }, so that agents send each other their positions";
  return std::nullopt;
}

/// The agent's present incarnation may command the vehicle.
void Driver::take_roster() {
  Author author;
  for (const RosterEntry& entry : me_.follower().roster()) {
    if (entry.author.agent == id_ && entry.active_until < 0) author = entry.author;
  }
  if (author != author_) answers_.clear();
  if (author.incarnation == 0) order({0, 0, 0});
  author_ = author;
}

/// Once a zone was announced, the commands are filtered again.
void Driver::take_zones() {
  const std::vector<Zone>& zones = me_.follower().amendments().zones;
  if (zones == zones_) return;
  zones_ = zones;
  if (!guard_) guard_.emplace(me_.mission(), 0);
  guard_->set_zones(zones_);
}

/// The driver that already drives the vehicle continues. If two began together, the one with the
/// greater identity stops.
void Driver::on(const WorldState& other, const Arrival& arrival) {
  const bool begins = !running_ || arrival.now < begun_ + kOtherDriver;
  if (!arrival.fresh || !begins) return;
  if (published_ && other.header.incarnation > me_.author().incarnation) return;
  for (const ergocast::Vehicle& vehicle : other.vehicles_in_part()) {
    if (vehicle.id == id_)
      return fail("vehicle " + std::to_string(id_) +
                  " is driven by another driver already: end that one first, or choose another "
                  "--id");
  }
}

void Driver::on(const Command& command, const Arrival& arrival) {
  if (command.header.sender != id_ || author_.incarnation != command.header.incarnation) return;
  const Tick last = answers_.empty() ? -1 : answers_.back().tick;
  // An agent may replace its command of a tick only by a stop.
  if (command.header.tick == last && command.velocity_mps.isZero(0)) order({0, 0, 0});
  if (command.header.tick > tick_ || command.header.tick <= last) return;
  answers_.push_back({command.header.tick, arrival.now});
  if (answers_.size() > kMostAnswers) answers_.pop_front();
  const Timing& timing = me_.mission().timing;
  const double age_s = static_cast<double>(tick_ - command.header.tick) * timing.dt_s;
  if (age_s > timing.command_hold_s) return order({0, 0, 0});
  const Eigen::Vector3d allowed_mps =
      within_speed_limit(motion_of(me_.mission(), id_), command.velocity_mps);
  if (allowed_mps != command.velocity_mps) ++clamped_commands_;
  order(allowed_mps);
  steer(arrival.now);
}

void Driver::order(const Eigen::Vector3d& velocity_mps) {
  commanded_mps_ = velocity_mps;
  if (velocity_mps.isZero(0)) vehicle_.fly(velocity_mps);
}

/// Walls and zones shorten the step; other vehicles are the agent's.
void Driver::steer(Instant now) {
  const auto fix = vehicle_.fix(now);
  if (commanded_mps_.isZero(0) || !fix) return vehicle_.fly({0, 0, 0});
  if (!guard_) return vehicle_.fly(commanded_mps_);
  const double limit_mps = motion_of(me_.mission(), id_).speed_limit_mps;
  Mover self{id_, tick_, fix->position_m, limit_mps > 0 ? limit_mps : commanded_mps_.norm(),
             fix->velocity_mps};
  if (me_.mission().domain.planar()) self.position_m.z() = me_.mission().domain.origin_m.z();
  vehicle_.fly(guard_->safe(self, commanded_mps_, {}).velocity_mps);
}

void Driver::advance(Instant now, Outbox& out, std::vector<Packet>& to_vehicle) {
  if (running_ && now >= next_tick_ && (!stopped_ || tells_until_it_stands_)) {
    if (stopped_) {
      ++tick_;
      if (vehicle_.done()) --last_states_;
    } else if (published_ && !me_.is_over(tick_)) {
      pass_tick(now);
    }
    if (me_.is_over(tick_)) order({0, 0, 0});  // until the coordinator has ended the mission
    publish(now, out);
    published_ = true;
    // Missed ticks are not repeated.
    next_tick_ = std::max(next_tick_ + seconds(me_.mission().timing.dt_s), now);
  }
  vehicle_.advance(now, to_vehicle);
  if (!vehicle_.fatal().empty()) fail(vehicle_.fatal());
}

Instant Driver::next_wakeup() const {
  const Instant vehicle = vehicle_.next_wakeup();
  const bool ticks = running_ && (!stopped_ || tells_until_it_stands_);
  return ticks ? std::min(next_tick_, vehicle) : vehicle;
}

/// The vehicle never moves for long without a command.
void Driver::pass_tick(Instant now) {
  const Timing& timing = me_.mission().timing;
  const Tick last = answers_.empty() ? -1 : answers_.back().tick;
  const double age_s = static_cast<double>(tick_ - last) * timing.dt_s;
  const bool driven = author_.incarnation != 0;
  if (driven && last < tick_) ++missed_deadlines_;
  if (!driven || age_s > timing.command_hold_s) order({0, 0, 0});
  steer(now);
  ++tick_;
}

/// The newest command that had arrived at `moment`.
Tick Driver::answered_at(Instant moment) const {
  const auto after =
      std::ranges::find_if(answers_, [&](const Answered& one) { return one.arrived > moment; });
  return after == answers_.begin() ? -1 : std::prev(after)->tick;
}

void Driver::publish(Instant now, Outbox& out) {
  const auto fix = vehicle_.fix(now);
  if (!fix) return;
  const Mission& mission = me_.mission();
  const bool flat = mission.domain.planar();
  WorldState state;
  state.roster_revision = me_.follower().revision();
  state.missed_deadlines = missed_deadlines_;
  state.clamped_commands = clamped_commands_;
  state.skipped_ticks = skipped_ticks_;
  state.uncounted_ticks = tick_ - me_.counted(tick_);
  // Each vehicle's driver sends one part of the state.
  auto vehicles = std::max(id_ + 1, static_cast<std::int32_t>(mission.starts_m.size()));
  for (const RosterEntry& entry : me_.follower().roster())
    vehicles = std::max(vehicles, entry.author.agent + 1);
  state.part = id_;
  state.parts = vehicles;
  ergocast::Vehicle& vehicle = state.add_vehicle();
  vehicle.id = id_;
  vehicle.answered_tick = answered_at(fix->not_before);
  vehicle.position_m = fix->position_m;
  vehicle.velocity_mps = fix->velocity_mps;
  if (commanded_mps_.isZero(0) && vehicle_.stands(now)) vehicle.velocity_mps.setZero();
  if (flat) {
    vehicle.position_m.z() = mission.domain.origin_m.z();
    vehicle.velocity_mps.z() = 0;
  }
  // Agents refuse a position outside the domain. But agents that keep distances need the true one.
  if (!keeps_distance(mission)) vehicle.position_m = mission.domain.nearest(vehicle.position_m);
  me_.publish(Bus::kWorld, state, tick_, out);
}

void Driver::stop(std::string reason) {
  if (stopped_) return;
  stopped_ = true;
  reason_ = std::move(reason);
  order({0, 0, 0});
  vehicle_.finish();
}

void Driver::fail(std::string reason) {
  if (failed_) return;
  failed_ = true;
  stop(std::move(reason));
}

}  // namespace ergocast::mavlink
