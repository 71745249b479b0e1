// SPDX-License-Identifier: BSD-3-Clause
// Holds states until a tick and its successor are complete, then writes the row and acknowledges
// the tick.
#include "logger/recorder.h"

#include <algorithm>
#include <chrono>

#include "core/mission/end_by_finding.h"
#include "core/motion/filter_rules.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

constexpr auto kAckPeriod = 100ms;
/// The period while a sent state is missing: an early acknowledgement lets the world repeat it
/// early.
constexpr auto kImpatientAckPeriod = 20ms;
constexpr Tick kAckEveryTicks = 16;
/// In real time no state is repeated: a missing one is given up after so many newer ones.
constexpr std::size_t kGiveUpAfterStates = 16;
/// A missing part of a state, from one driver of many, is given up after so many newer states.
constexpr std::size_t kDriverPatience = kGiveUpAfterStates / 2;
/// Lockstep: a state that is more than so many ticks ahead is forged, or no row can be written. In
/// real time the record may be behind by any number of ticks.
constexpr auto kLeadTicks = static_cast<Tick>(kMaxWaitingStates);
/// Lockstep: how long to wait for the repetition of a state that may be lost for good.
constexpr auto kRepeatPatience = 500ms;
/// How long after the end, or the last row, a missing state or an agent's last status may arrive.
constexpr auto kLinger = 1s;
/// How often contacts are listed anew.
constexpr double kContactsPeriod_s = 1;

}  // namespace

Recorder::Recorder(RunId run, Incarnation incarnation, std::ostream& trajectory,
                   std::ostream& metrics)
    : me_(kRole, {run, kLogger, incarnation}), tables_(trajectory, metrics) {}

void Recorder::resume(RunData past, std::vector<std::byte> plan) {
  me_.expect_plan(std::move(plan));
  resumed_ = true;
  for (const auto& [agent, track] : past.tracks) row_.tick = std::max(row_.tick, track.back().tick);
  amendments_ = past.amendments;
  former_rows_ = std::move(past);
}

void Recorder::go_on(Instant now) {
  me_.set_incarnation(me_.incarnation() + 1);
  received_.lost_before = std::max(received_.lost_before, received_.newest);
  progress_ = now;
  next_ack_ = now;
}

void Recorder::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  if (ending_.finished) return;
  // On this bus an agent repeats a former world's state for a restarted world.
  if (bus == Bus::kCommand && std::holds_alternative<WorldState>(message)) return;
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
}

void Recorder::on(const AgentStatus& status, const Arrival& arrival) {
  if (arrival.fresh) reports_.take(status);
}

void Recorder::on(const MissionPart&, const Arrival& arrival) {
  if (!arrival.mission_changed) return;
  if (follower().plan_problem()) return fail(*follower().plan_problem());
  if (me_.knows_mission()) amendments_.note(follower().amendments());
  if (me_.knows_mission() && !tables_.begun()) begin();
  if (!follower().over() || ending_.since) return;
  ending_.since = arrival.now;
  ending_.failed = follower().state() == MissionState::kFailed;
  ending_.reason = follower().reason();
}

void Recorder::on(const Stop& stop, const Arrival& arrival) {
  if (!stop.now || me_.run() == 0 || ending_.since) return;
  ending_.since = arrival.now;
  tables_.facts().halted = true;
  ending_.failed = stop.failed;
  ending_.reason = stop.reason;
}

void Recorder::begin() {
  tables_.begin(mission());
  if (former_rows_) row_ = tables_.replay(*former_rows_, known());
  former_rows_.reset();
  states_.drop_before(row_.tick);
}

bool Recorder::is_lockstep() const {
  return !me_.knows_mission() || mission().timing.pace == Pace::kLockstep;
}

void Recorder::on(const WorldState& world, const Arrival& arrival) {
  const Tick tick = world.header.tick;
  if (me_.knows_mission()) {
    if (tick - world.uncounted_ticks > me_.tick_count()) return;
    received_.newest = std::max(received_.newest, tick);
    if (arrival.fresh) meet(world.header, arrival.now);
    if (arrival.fresh) received_.world_left = world.last;
    received_.drivers = received_.drivers || is_of_a_driver(world);
  }
  const Tick horizon = std::max(row_.tick, received_.lost_before) + kLeadTicks;
  if (tick < row_.tick || (is_lockstep() && tick > horizon)) return;
  RunFacts& facts = tables_.facts();
  facts.missed_deadlines = std::max(facts.missed_deadlines, world.missed_deadlines);
  facts.skipped_ticks = std::max(facts.skipped_ticks, world.skipped_ticks);
  facts.clamped_commands = std::max(facts.clamped_commands, world.clamped_commands);
  states_.take(world, has_drivers());
}

void Recorder::meet(const Header& world, Instant now) {
  if (world.incarnation == received_.world) return;
  const bool from_the_start = received_.world == 0 && !resumed_;
  received_.world = world.incarnation;
  if (from_the_start) return;
  received_.lost_before = std::max(received_.lost_before, world.tick);
  progress_ = now;
}

void Recorder::advance(Instant now, Outbox& out) {
  if (ending_.finished) return;
  if (me_.knows_mission()) {
    if (given_up(now)) go_on(now);
    write_rows(now);
    if (all_rows_written() && !ending_.since) {
      ending_.since = now;
      ending_.reason =
          why_complete(mission().objects, static_cast<int>(tables_.facts().finds.list().size()));
    }
  }
  const bool patience_ends = ending_.since && now - std::max(*ending_.since, progress_) >= kLinger;
  if (patience_ends || everybody_left(now)) close();
  if (abandoned(now)) {
    stop("nothing arrives from the world or the coordinator, and the mission must be over by now");
  }
  if (me_.knows_mission()) acknowledge(now, out);
  if (ending_.finished && follower().over()) {
    me_.publish(Bus::kWorld, record_ack(true), row_.tick - 1, out);  // to the coordinator
  }
}

/// Whether no missing data can arrive any more, because all processes have left.
bool Recorder::everybody_left(Instant now) const {
  if (!ending_.since || !follower().over() || !received_.world_left) return false;
  if (row_.tick < received_.newest) return false;
  return me_.team_has_left(
      follower().roster(), [&](const Author& author) { return reports_.finished(author); }, now);
}

void Recorder::write_rows(Instant now) {
  while (true) {
    while (write_next_row(now)) progress_ = now;
    if (!tables_.good() || !gap_ahead() || !gap_is_final(now)) return;
    skip_gap();
  }
}

std::vector<Contact> Recorder::contacts() const {
  std::vector<Contact> all = tables_.contacts();
  for (Contact& one : all) one.t_s = static_cast<double>(one.newest) * mission().timing.dt_s;
  return all;
}

/// Contacts are listed anew once a second of the mission, because that costs a renewal.
bool Recorder::contacts_are_old() const {
  const double dt_s = mission().timing.dt_s;
  return !contacts_at_ ||
         static_cast<double>(row_.tick - *contacts_at_) * dt_s >= kContactsPeriod_s;
}

RecordAck Recorder::record_ack(bool last) {
  if (me_.knows_mission() && mission().sensor.has_false_alarms() && contacts_are_old()) {
    contacts_ = tables_.contacts();
    contacts_at_ = row_.tick;
  }
  RecordAck ack{{}, last, tables_.detection_probability()};
  ack.wrong_confirmations = tables_.facts().wrong_confirmations.value_or(0);
  for (const Find& find : tables_.facts().finds.list())
    ack.finds[static_cast<std::size_t>(ack.find_count++)] = find;
  const std::int32_t room = ack.contact_room();
  for (const Contact& contact : contacts_) {
    if (ack.contact_count >= room) break;
    ack.contacts[static_cast<std::size_t>(ack.contact_count++)] = contact;
  }
  return ack;
}

void Recorder::acknowledge(Instant now, Outbox& out) {
  const Tick recorded = row_.tick - 1;
  const bool last = ending_.finished || all_rows_written();
  const bool progress = recorded > acked_ + kAckEveryTicks - 1 || (last && recorded > acked_);
  if (!progress && now < next_ack_) return;
  tables_.flush();
  const bool hole = !states_.empty() && states_.last() > row_.tick + 1;
  next_ack_ = now + (hole ? kImpatientAckPeriod : kAckPeriod);
  if (!tables_.good()) return;
  acked_ = recorded;
  me_.publish(Bus::kCommand, record_ack(false), recorded, out);
}

bool Recorder::abandoned(Instant now) const {
  if (ending_.finished || ending_.since) return false;
  return me_.cut_off(states_.empty() ? row_.tick : states_.last(), now);
}

Instant Recorder::next_wakeup() const {
  return ending_.finished || !me_.knows_mission() ? Instant::max() : next_ack_;
}

void Recorder::stop(std::string reason) {
  if (!ending_.since) ending_.reason = std::move(reason);
  close();
}

void Recorder::fail(std::string reason) {
  ending_.failed = true;
  stop(std::move(reason));
}

void Recorder::close() {
  if (ending_.finished) return;
  ending_.finished = true;
  tables_.begin_without_mission();
  // Only a row that waited for a missing part or for the mission can be written now.
  while ((has_drivers() || awaits_mission_since_) && write_next_row(progress_)) {
  }
  // The last chance to write the rows after a gap.
  received_.lost_before = std::max(received_.lost_before, received_.newest);
  while (tables_.good() && gap_ahead() && states_.first_pair()) {
    skip_gap();
    while (write_next_row(progress_)) {
    }
  }
}

const char* Recorder::result() const {
  if (ending_.failed || facts().no_metric_from) return "failed";
  return all_rows_written() ? "done" : "stopped";
}

bool Recorder::holds(Tick tick) const {
  if (states_.complete(tick)) return true;
  if (!has_drivers() || !states_.has(tick)) return false;
  return ending_.finished || states_.last() >= tick + static_cast<Tick>(kDriverPatience);
}

/// Whether several drivers may send a tick, each its own robot's part. Then a row is also written
/// without a robot whose driver is silent.
bool Recorder::has_drivers() const {
  return me_.knows_mission() && (uses_beacons(mission()) || received_.drivers);
}

/// A driver of one robot sends as many parts as the team has robots; one world needs fewer.
bool Recorder::is_of_a_driver(const WorldState& part) const {
  AgentId robots = static_cast<AgentId>(mission().starts_m.size());
  for (const RosterEntry& entry : follower().roster())
    robots = std::max(robots, entry.author.agent + 1);
  return !is_lockstep() && part.parts > (robots + kMaxVehiclesPerState - 1) / kMaxVehiclesPerState;
}

bool Recorder::write_next_row(Instant now) {
  if (!tables_.good() || all_rows_written()) return false;
  if (!holds(row_.tick) || !holds(row_.tick + 1)) return false;
  const TickState &state = states_.at(row_.tick), &next = states_.at(row_.tick + 1);
  if (awaits_mission(state, now)) return false;
  if (has_drivers())
    tables_.facts().lost_positions += states_.add_lost(row_.tick + 1, mission().timing.dt_s);
  tables_.facts().missing_positions += missing_positions(state, next);
  row_.uncounted = state.uncounted_ticks;
  row_.counts = next.uncounted_ticks <= state.uncounted_ticks;
  tables_.write(row_, state, next, known());
  row_.pass();
  states_.drop_before(row_.tick);
  return true;
}

/// How many members of the team have no row at this tick: a row needs the state after it, too.
std::int64_t Recorder::missing_positions(const TickState& state, const TickState& next) const {
  AgentId counted = kUnassigned;  // the roster ascends by number
  return std::ranges::count_if(follower().roster(), [&](const RosterEntry& entry) {
    const AgentId id = entry.author.agent;
    if (id == counted || !entry.active_at(row_.tick)) return false;
    counted = id;
    return !state.vehicles.contains(id) || !next.vehicles.contains(id);
  });
}

/// Lockstep: whether this state waits for the revision of the mission that its world knew. Its
/// coordinator repeats it, but may have stopped. So the wait ends before the world gives us up.
bool Recorder::awaits_mission(const TickState& state, Instant now) {
  const bool lacks = is_lockstep() && follower().revision() < state.roster_revision;
  if (!lacks) {
    awaits_mission_since_.reset();
  } else if (!awaits_mission_since_) {
    awaits_mission_since_ = now;
  }
  return lacks && !ending_.finished &&
         now - *awaits_mission_since_ < seconds(mission().timing.lockstep_timeout_s / 4);
}

/// Whether a state that may be lost for good is missing and newer ones have arrived.
bool Recorder::gap_ahead() const {
  if (!me_.knows_mission() || all_rows_written() || states_.empty()) return false;
  const Tick missing = holds(row_.tick) ? row_.tick + 1 : row_.tick;
  if (holds(missing)) return false;  // the row waits for the mission
  return states_.last() > missing && (!is_lockstep() || missing < received_.lost_before);
}

bool Recorder::gap_is_final(Instant now) const {
  return is_lockstep() ? now - progress_ >= kRepeatPatience : states_.size() >= kGiveUpAfterStates;
}

/// Lockstep: whether the world continues without this recorder. It does so when it received no
/// acknowledgement for half of the time-out. The recorder was then disconnected, and no process
/// repeats the states of that time.
bool Recorder::given_up(Instant now) const {
  const Tick expected = std::max(row_.tick, received_.lost_before) + kRecordWindowTicks;
  return is_lockstep() && tables_.good() && received_.newest > expected &&
         now - progress_ > seconds(mission().timing.lockstep_timeout_s / 2);
}

/// Continues with the first two successive states.
void Recorder::skip_gap() {
  Tick resume = states_.first_pair().value_or(states_.last());
  if (is_lockstep()) resume = std::min(resume, received_.lost_before);
  tables_.skip(row_, resume);
  row_.tick = resume;
  row_.uncounted =
      states_.has(resume) ? states_.at(resume).uncounted_ticks : resume - me_.counted(resume);
  states_.drop_before(resume);
}

}  // namespace ergocast
