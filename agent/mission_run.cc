// SPDX-License-Identifier: BSD-3-Clause
// Takes in the messages of teammates and of the world, and acts once a tick has come.
#include "agent/mission_run.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/mission/hold.h"
#include "core/motion/home.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

/// A status is also due after this mission time, so that a fast lockstep run has statuses too.
constexpr double kStatusMissionPeriod_s = 1.0;
/// How far ahead of us a teammate's coverage may be before it counts as forged.
/// Limit (Time): lead of a contribution over the receiver, in mission time [s]. Beyond it: a
/// contribution that is beyond both limits is refused with `range`.
constexpr double kLead_s = 60;
/// Limit (Time): lead of a contribution over the receiver [steps]. Beyond it: a contribution that
/// is beyond both limits is refused with `range`.
constexpr Tick kLeadTicks = 64;
/// How often an agent broadcasts what it has while it gets no new tick.
constexpr auto kStallPeriod = 1s;

/// How many messages of members were lost on the swarm bus.
std::int64_t lost(const Participant& me) {
  std::int64_t lost = 0;
  for (const RosterEntry& entry : me.follower().roster()) {
    lost += me.liveness().lost(entry.author, Bus::kSwarm);
  }
  return lost;
}

}  // namespace

MissionRun::MissionRun(const Participant& me, const RosterEntry& self, const LawMaker& laws)
    : active_from_(self.active_from),
      radio_(me.mission().radio_range_m),
      exchange_(me.mission(), self, me.counted(self.active_from)),
      ends_(me.mission()),
      shift_(me.mission()),
      guidance_(me.mission(), self, laws),
      motion_(me.mission(), self.author, me.follower().revision()) {
  if (guidance_.searches()) search_.emplace(me.mission(), self);
  last_command_.header.tick = command_before_.header.tick = -1;
  note_roster(me);
}

std::optional<MissionOver> MissionRun::evicted(const Participant& me, Tick tick) {
  const RosterEntry* own = me.follower().entry_of(me.incarnation());
  if (own == nullptr || own->active_until < 0) return std::nullopt;
  // A restarted world has no vehicle for it, and so no tick.
  if (own->leaves) return MissionOver{false, kSentOut, true};
  if (own->active_until > tick) return std::nullopt;
  return MissionOver{true, "evicted from the roster at tick " + std::to_string(own->active_until)};
}

// ---- what the agent learns ----

/// Prepares here what depends on roster and amendments, because a control step must not allocate.
/// Only these are computed in the step that needs them: ways around zones and walls, and what a law
/// reads or plans of a new team or target (core/law/mower.h).
void MissionRun::note_roster(const Participant& me) {
  const MissionFollower& known = me.follower();
  const RosterEntry* const own = known.entry_of(me.incarnation());
  if (own != nullptr && own->recalled()) motion_.prepare_recall(me.mission());
  ends_.note(known.amendments());
  has_known_ends_ = has_known_ends_ || !ends_.is_plans();
  shift_.note(known.amendments());
  if (shift_.any_of_samples()) exchange_.allow_shifts();
  if (search_) search_->note(known.amendments());
  motion_.note_zones(known.amendments().zones, me.mission());
  motion_.note_roster(known.roster());
  if (!known.holds().empty()) held_roster_ = in_counted_ticks(known.roster(), known.holds());
}

void MissionRun::start(Instant now) {
  if (!running_since_) running_since_ = now;
}

const std::vector<RosterEntry>& MissionRun::counted_roster(const Participant& me) const {
  return me.follower().holds().empty() ? me.follower().roster() : held_roster_;
}

Tick MissionRun::lead(const Participant& me, Instant now) const {
  const Timing& timing = me.timing();
  Tick lead = std::max(kLeadTicks, static_cast<Tick>(kLead_s / timing.dt_s));
  if (timing.pace == Pace::kRealtime && step_.tick >= 0) {
    // Teammates have continued while we received nothing from the world. Twice that time allows for
    // clocks that differ.
    const Instant heard = std::max(running_since_.value_or(Instant{}),
                                   me.liveness().last_sign_of_kind(kWorld).value_or(Instant{}));
    const double unheard_s = std::chrono::duration<double>(now - heard).count();
    lead += static_cast<Tick>(2 * unheard_s * timing.realtime_factor / timing.dt_s);
  }
  return lead;
}

std::int64_t MissionRun::max_steps(const RosterEntry& author, const Participant& me,
                                   Tick lead) const {
  const Tick current = me.counted(step_.tick) + 1;
  return lead + (author.active_until < 0 ? current
                                         : std::min(current, me.counted(author.active_until) + 1));
}

void MissionRun::on(const Contribution& theirs, const Arrival& arrival, Participant& me) {
  const RosterEntry* const entry = me.member(theirs.header);
  if (entry == nullptr) return;  // not a member as far as we know
  exchange_.note_received(theirs, arrival.transmitter);
  const Tick lead = this->lead(me, arrival.now);
  const std::int64_t limit = max_steps(*entry, me, lead);
  // With a half-life, a row of a far tick would weigh more than all others.
  const bool is_far = exchange_.table().half_life().any() &&
                      theirs.header.tick > me.counted(std::max<Tick>(step_.tick, 0)) + lead;
  // Before our first tick we do not know the mission's time. The count may be right, so it is
  // ignored and not counted as refused.
  if (step_.tick < 0 && (theirs.steps > limit || is_far)) return;
  // Its author may not know yet that it was sent out of the mission.
  if (entry->leaves && theirs.steps > limit) return;
  if (is_far) return me.count_refused(Refusal::kRange);
  const auto refusal = exchange_.merge(theirs, entry->kind, limit, step_.counted);
  if (refusal) me.count_refused(*refusal);
}

void MissionRun::on(const Digest& theirs, const Arrival& arrival, Participant& me) {
  if (!arrival.fresh || me.member(theirs.header) == nullptr) return;
  exchange_.on(theirs, step_, me, arrival.now);
}

void MissionRun::on(const Effort& theirs, const Arrival& arrival, Participant& me) {
  const RosterEntry* const entry = me.member(theirs.header);
  if (entry == nullptr || !search_ || step_.tick < 0) return;
  const Tick newest = step_.counted + lead(me, arrival.now);
  const bool by_author = arrival.transmitter == theirs.header.sender;
  if (const auto refusal = search_->receive(theirs, newest, by_author)) me.count_refused(*refusal);
}

void MissionRun::on(const Beacon& beacon, const Arrival& arrival, Participant&) {
  motion_.bodies().on(beacon, arrival.fresh, {step_.tick, arrival.now});
}

void MissionRun::on(const WorldState& world, const Arrival& arrival, Participant& me) {
  const Tick tick = world.header.tick;
  radio_.on(world);
  guidance_.on(world, radio_, me);
  motion_.on(world);
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    if (vehicle.id != me.id()) continue;
    // The world may repeat an old state for the logger. Before our admission our predecessor drove.
    if (tick < active_from_ && vehicle.answered_tick > answered_) return;
    if (!motion_.filters() && !me.mission().domain.contains(vehicle.position_m)) {
      return me.count_refused(Refusal::kRange);
    }
    if (tick < (pending_ ? pending_->tick : step_.tick)) {
      world_is_behind_ = world_is_behind_ || (arrival.fresh && is_behind(tick, me, arrival.now));
      repeat_wanted_ = repeat_wanted_ || world_is_behind_;
      return;
    }
    if (tick == step_.tick) {
      repeat_wanted_ = repeat_wanted_ || arrival.fresh;
      return;
    }
    pending_ = OwnState{tick,
                        world.roster_revision,
                        vehicle.answered_tick,
                        vehicle.position_m,
                        vehicle.velocity_mps,
                        vehicle.reported_cell,
                        vehicle.charge_ppm};
  }
}

/// Whether ticks have stopped because a restarted world is at an earlier tick. It then waits for
/// our answer to that tick, and teammates that have restarted, too, for what we sent.
bool MissionRun::is_behind(Tick world_tick, const Participant& me, Instant now) const {
  return me.timing().pace == Pace::kLockstep && world_tick < step_.tick &&
         now - step_.begun >= kStallPeriod;
}

// ---- a tick ----

std::optional<MissionOver> MissionRun::advance(Participant& me, Instant now, Outbox& out) {
  if (may_begin(me)) {
    if (auto over = begin_tick(me, now, out)) return over;
  }
  if (repeat_wanted_) repeat(me, out);
  if (answered_ < step_.tick) {
    waiting_for_ = awaited(me);
    if (waiting_for_ == kUnassigned) answer(me, out);
  }
  if (stalled(me, now)) {
    stall_announced_ = now;
    exchange_.broadcast(true, step_, ends_, me, out);
  }
  if (!me.cut_off(step_.tick, now)) return std::nullopt;
  return MissionOver{true,
                     "nothing arrives from the world or the coordinator, and the mission must be "
                     "over by now: check this host's network"};
}

/// Lockstep: an agent needs the revision that the world names, which decides whether the tick
/// counts and which agents take part. A restarted world may have continued before all agents knew
/// it.
bool MissionRun::may_begin(const Participant& me) const {
  if (!pending_) return false;
  return me.timing().pace == Pace::kRealtime ||
         me.follower().revision() >= pending_->roster_revision;
}

std::optional<MissionOver> MissionRun::begin_tick(Participant& me, Instant now, Outbox& out) {
  const Mission& mission = me.mission();
  const OwnState own = *std::exchange(pending_, std::nullopt);
  repeat_wanted_ = world_is_behind_ = false;
  if (me.is_over(own.tick)) {
    step_.tick = own.tick;
    return MissionOver{false, "mission complete"};
  }
  if (auto over = evicted(me, own.tick)) return over;
  if (step_.tick >= 0) missed_ticks_ += own.tick - step_.tick - 1;
  const Tick tick_before = step_.tick;
  const PlaceAtTick before{step_.counted, step_.x_m};
  step_.tick = own.tick;
  step_.counted = me.counted(own.tick);
  step_.held = me.is_held(own.tick);
  step_.begun = now;
  step_.roster_revision = own.roster_revision;
  step_.body_m = own.position_m;
  step_.body_mps = own.velocity_mps;
  step_.reported_cell = own.reported_cell;
  step_.charge_ppm = own.charge_ppm;
  step_.x_m = mission.domain.nearest(own.position_m);
  step_.basis_at.emplace(step_.x_m, mission.domain, mission.basis);
  const RosterEntry* const entry = me.follower().entry_of(me.incarnation());
  step_.recalled = entry != nullptr && entry->recalled_at(own.roster_revision);
  if (step_.recalled && entry->leaves) return MissionOver{false, kSentOut, true};
  motion_.bodies().begin(own, step_, me, out);
  // A restarted world may be a tick behind the roster. Our predecessor has covered that tick.
  const bool counts = step_.tick >= active_from_ && !step_.held;
  const bool is_first = exchange_.table().steps_held(me.author()).value_or(0) == 0;
  const bool charges =
      !is_first && ergocast::charges(mission, me.id(), own.position_m, own.velocity_mps);
  const bool covers =
      counts && !step_.recalled && !charges && !ends_.rests(mission, me.id(), step_.counted);
  // A pause that ended meanwhile is not part of the line.
  const bool goes_on = step_.counted - before.tick == step_.tick - tick_before;
  if (std::exchange(covered_, covers) && covers && goes_on) add_lost_samples(before, mission);
  exchange_.set_now(step_.counted);
  if (!counts) return std::nullopt;
  if (covers) exchange_.add_sample(step_.counted, *step_.basis_at, shift_);
  exchange_.broadcast(false, step_, ends_, me, out);
  if (search_) search_->begin(step_, covers, me, out);
  return std::nullopt;
}

/// The vehicle has gone on in ticks whose states did not arrive.
void MissionRun::add_lost_samples(const PlaceAtTick& before, const Mission& mission) {
  for_each_lost_place(before, {step_.counted, step_.x_m}, [&](const PlaceAtTick& lost) {
    exchange_.set_now(lost.tick);
    exchange_.add_sample(lost.tick, BasisAt(lost.x_m, mission.domain, mission.basis), shift_);
  });
}

/// What the tick waits for before it can be answered: a teammate's block, or the world's state.
/// kUnassigned: nothing.
AgentId MissionRun::awaited(const Participant& me) const {
  if (!motion_.knows_bodies(step_.tick)) return kWorld;
  if (me.timing().pace == Pace::kRealtime || step_.held) return kUnassigned;
  if (!guidance_.has_state_of(step_.tick)) return kWorld;
  const AgentId awaited = exchange_.awaited(step_, radio_, ends_, me);
  return awaited == kUnassigned && search_ ? search_->awaited(step_, radio_, me) : awaited;
}

/// A command of 0 is wanted in a pause: the vehicle brakes, then stands or loiters.
void MissionRun::answer(Participant& me, Outbox& out) {
  command_before_ = last_command_;
  exchange_.forget_silent(step_, me);
  if (has_known_ends_) {
    motion_.set_rest(ends_.rest_from(me.mission(), me.id(), step_.counted));
    guidance_.note_ends(me.mission(), ends_, step_.counted);
  }
  guidance_.note_amendments(me.mission(), me.follower().amendments(), step_.tick);
  Eigen::Vector3d wanted_mps{0, 0, 0};
  if (!step_.held)
    wanted_mps =
        guidance_.wanted_mps(exchange_.table(), efforts(), counted_roster(me), shift_, step_);
  last_command_.header.tick = answered_ = step_.tick;
  last_command_.position_m = step_.x_m;
  last_command_.charge_ppm = step_.charge_ppm;
  last_command_.velocity_mps = motion_.command_mps(wanted_mps, step_, me);
  motion_.bodies().answered(step_);
  me.publish(Bus::kCommand, last_command_, step_.tick, out);
}

void MissionRun::repeat(Participant& me, Outbox& out) {
  repeat_wanted_ = false;
  exchange_.repeat(me, out);
  if (search_) search_->repeat(me, out);
  const bool behind = std::exchange(world_is_behind_, false);
  if (behind && command_before_.header.tick >= 0)
    me.publish(Bus::kCommand, command_before_, command_before_.header.tick, out);
  if (answered_ >= 0 && (behind || answered_ == step_.tick))
    me.publish(Bus::kCommand, last_command_, answered_, out);
}

/// Whether ticks have stopped in real time, so that the agent broadcasts what it has. In lockstep
/// no broadcast may come before the one that was announced. In a pause there is nothing new to
/// send, and an agent that joined during it has no coverage at all.
bool MissionRun::stalled(const Participant& me, Instant now) const {
  return me.timing().pace == Pace::kRealtime && !step_.held && step_.tick >= active_from_ &&
         now - std::max(step_.begun, stall_announced_) >= kStallPeriod;
}

void MissionRun::stop_vehicle(Participant& me, Outbox& out) {
  last_command_.position_m = step_.x_m;
  last_command_.velocity_mps.setZero();
  me.publish(Bus::kCommand, last_command_, step_.tick, out);
}

// ---- help ----

void MissionRun::help(Participant& me, Instant now, Outbox& out) {
  if (asking_world_) report_position(me, out);
  exchange_.repair(counted_roster(me), step_, me, now, out);
}

void MissionRun::report_position(Participant& me, Outbox& out) {
  // The vehicles of departed agents stand somewhere, and only agents still know where.
  for (const WorldState& state : motion_.bodies().states()) out.push_back({Bus::kCommand, state});
  for (Command command : {command_before_, last_command_}) {
    command.asked_by = *asking_world_;
    me.publish(Bus::kCommand, command, command.header.tick, out);
  }
  asking_world_.reset();
}

Instant MissionRun::next_wakeup() const {
  return std::min(next_status_.at, exchange_.next_repair());
}

// ---- status ----

AgentPhase MissionRun::phase(const Participant& me) const {
  if (!started()) return AgentPhase::kWaiting;
  if (step_.recalled)
    return motion_.is_home(me.mission(), step_.body_m) ? AgentPhase::kResting
                                                       : AgentPhase::kReturning;
  if (!motion_.has_station()) return AgentPhase::kRunning;
  if (ends_.rests(me.mission(), me.id(), step_.counted)) return AgentPhase::kResting;
  return motion_.returns() ? AgentPhase::kReturning : AgentPhase::kRunning;
}

void MissionRun::fill_in(AgentStatus& status, const Participant& me) const {
  if (step_.tick >= 0) {
    status.ergodic_metric = guidance_.metric(team_coverage(), shift_, step_.counted);
    status.max_staleness_s =
        static_cast<double>(exchange_.oldest_update_age(step_, ends_, me)) * me.timing().dt_s;
  }
  status.waiting_for = waiting_for_;
  status.answered_tick = answered_;
  status.missed_ticks = missed_ticks_;
  status.contributions_received = exchange_.received();
  status.contributions_relayed = exchange_.relayed();
  status.contributions_lost = lost(me);
  status.messages_sent = me.sent();
  status.messages_received = me.received();
  status.refused = me.refused();
  const BlockedTicks& blocked = motion_.blocked();
  status.blocked_by = blocked.by;
  status.blocked_now_ticks = blocked.now;
  status.blocked_ticks = blocked.all;
  status.longest_block_ticks = blocked.longest;
}

void MissionRun::publish_status(AgentStatus status, Participant& me, Instant now, Outbox& out) {
  status.phase = phase(me);
  fill_in(status, me);
  if (running_since_ && me.silent(kWorld, now, *running_since_)) status.waiting_for = kWorld;
  me.publish(Bus::kSwarm, status, std::max<Tick>(step_.tick, 0), out);
  next_status_ =
      Deadline::in(kAgentStatusPeriod, now, kStatusMissionPeriod_s, me.timing().dt_s, step_.tick);
}

void MissionRun::publish_last_status(AgentStatus status, Participant& me, Outbox& out) const {
  status.phase = AgentPhase::kFinished;
  fill_in(status, me);
  me.publish(Bus::kSwarm, status, std::max<Tick>(step_.tick, 0), out);
}

}  // namespace ergocast
