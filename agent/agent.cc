// SPDX-License-Identifier: BSD-3-Clause
// Joins the mission, takes in messages and reports the agent's status; mission_run.cc has the tick.
#include "agent/agent.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "core/require.h"
#include "core/station.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

constexpr auto kHelloPeriod = 250ms;
/// A newer roster makes the next HELLO due at once, because HELLO must name it. This is the
/// shortest time between two.
constexpr auto kHelloGap = 10ms;
/// A status is also due after this mission time, so that a fast lockstep run has statuses too.
constexpr double kStatusMissionPeriod_s = 1.0;
/// How far ahead of us a teammate's coverage may be before it counts as forged.
/// Limit (Time): lead of a contribution over the receiver, in mission time [s]. Beyond it: a
/// contribution that is beyond both limits is refused with `range`.
constexpr double kLead_s = 60;
/// Limit (Time): lead of a contribution over the receiver [steps]. Beyond it: a contribution that
/// is beyond both limits is refused with `range`.
constexpr Tick kLeadTicks = 64;
/// How long another process must send under our id before we conclude that it runs. Repeats of a
/// stopped process do not deceive the coordinator: it would have admitted us by then.
constexpr auto kDuplicateIdPatience = 5s;

const Coefficients kNoCoverage;

}  // namespace

Agent::InMission::InMission(const Mission& mission, const RosterEntry& self, Tick joined)
    : active_from(self.active_from),
      kind(self.kind),
      sensors(mission),
      table(mission.basis, mission.timing.dt_s, joined),
      controller(mission, self.kind),
      anti_entropy(self.author, mission.seed, mission.timing.dt_s),
      foreseen(Coefficients::Zero(mission.basis.mode_count())),
      team_coverage(foreseen) {
  table.set_layout(BlockLayout(mission));
  if (mission.law.anticipation > 0) {
    forecast.emplace(mission, self.author);
  } else {
    table.forgo_gains();
  }
  if (filters_commands(mission, self.author.agent))
    separation.emplace(mission, unguarded_hold_ticks(mission));
  if (follows_walls(mission)) follower.emplace(mission, self.author.agent);
  if (station_of(mission, self.author.agent)) way_home.emplace(mission, self.author.agent);
  table.add_row(self.author);  // before any other incarnation could take its place
  table.set_quality(self.author, sensors.of(self.kind).quality);
  published.resize(static_cast<std::size_t>(table.block_count()));
  last_command.header.tick = command_before.header.tick = -1;
}

Agent::Agent(AgentIdentity identity)
    : me_(kRole, {identity.run, identity.requested_id, identity.incarnation}),
      requested_id_(identity.requested_id),
      version_(std::move(identity.version)),
      kind_(std::move(identity.kind)),
      mission_repeat_(identity.incarnation) {
  ERGOCAST_REQUIRE(identity.incarnation != 0);
  status_.host = std::move(identity.host);
}

void Agent::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  // A message from out of range counts as never received.
  if (finished() || !radio_.receives(me_.id(), transmitter)) return;
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
}

const Agent::InMission* Agent::mission_run() const {
  const auto* end = std::get_if<Finished>(&state_);
  if (end == nullptr) return std::get_if<InMission>(&state_);
  return end->mission ? &*end->mission : nullptr;
}

// ---- the mission ----

void Agent::on(const MissionPart& part, const Arrival& arrival) {
  mission_repeat_.overheard(part.revision, follower().revision(), arrival.now, me_.received());
  if (follower().newest_heard() > hellos_.revision) {
    hellos_.next = std::min(hellos_.next, std::max(arrival.now, hellos_.last + kHelloGap));
  }
  if (!arrival.mission_changed) return;
  if (follower().plan_problem()) return finish(true, *follower().plan_problem());
  if (follower().over()) {
    return finish(follower().state() == MissionState::kFailed, follower().reason());
  }
  if (auto why = why_not_of_kind(mission(), kind_, requested_id_))
    return finish(true, *std::move(why));
  note_roster();
  const RosterEntry* own = own_entry();
  if (own == nullptr) return;
  if (const auto why = evicted(std::max<Tick>(tick(), 0))) return finish(true, *why);
  if (std::holds_alternative<Joining>(state_)) {
    me_.set_id(own->author.agent);
    radio_ = RadioRange(mission().radio_range_m);
    state_.emplace<InMission>(mission(), *own, me_.counted(own->active_from));
    if (uses_beacons(mission()))
      in_mission()->beacons.emplace(mission(), own->author, follower().revision());
    note_roster();
  }
  std::optional<Instant>& running_since = in_mission()->running_since;
  if (!running_since && follower().state() == MissionState::kRunning) running_since = arrival.now;
}

/// Prepares here what depends on the roster, because a control step must not allocate.
void Agent::note_roster() {
  InMission* const mission_run = in_mission();
  if (mission_run == nullptr) return;
  if (mission_run->beacons) mission_run->beacons->note_roster(follower().roster());
  if (follower().holds().empty()) return;
  mission_run->held_roster = in_counted_ticks(follower().roster(), follower().holds());
}

/// The reason if it is no longer a member at `tick`, else nothing.
std::optional<std::string> Agent::evicted(Tick tick) const {
  const RosterEntry* own = own_entry();
  if (own == nullptr || own->active_until < 0 || own->active_until > tick) return std::nullopt;
  return "evicted from the roster at tick " + std::to_string(own->active_until);
}

void Agent::on(const Hello& hello, const Arrival& arrival) {
  if (!me_.knows_mission() || !arrival.fresh) return;
  InMission* const mission_run = in_mission();
  if (hello.header.sender == kWorld && mission_run)
    mission_run->asking_world = hello.header.incarnation;
  if (asks_for_mission(hello)) mission_repeat_.asked(arrival.now, me_.received());
}

void Agent::on(const AgentStatus& status, const Arrival& arrival) {
  auto* const joining = std::get_if<Joining>(&state_);
  const bool duplicate_id = joining != nullptr && requested_id_ != kUnassigned && arrival.fresh &&
                            status.header.sender == requested_id_;
  if (!duplicate_id) return;
  if (!joining->duplicate_id_since) joining->duplicate_id_since = arrival.now;
  if (arrival.now - *joining->duplicate_id_since < kDuplicateIdPatience) return;
  finish(true, "agent " + std::to_string(requested_id_) + " is already running on " + status.host +
                   ": choose another id, or none");
}

void Agent::on(const Stop& stop, const Arrival&) {
  // Before it knows its run, a STOP may be a repeat that ended a former run. A STOP without `now`
  // is for the coordinator, which then ends the mission for all.
  if (me_.run() == 0 || !stop.now) return;
  finish(stop.failed, stop.reason, phase() == AgentPhase::kRunning && tick() >= 0);
}

// ---- messages of teammates and of the world ----

std::int64_t Agent::max_steps(const InMission& mission_run, const RosterEntry& author,
                              Instant now) const {
  const Timing& timing = mission().timing;
  const Tick tick = mission_run.step.tick;
  Tick lead = std::max(kLeadTicks, static_cast<Tick>(kLead_s / timing.dt_s));
  if (timing.pace == Pace::kRealtime && tick >= 0) {
    // Teammates have continued while we received nothing from the world. Twice that time allows for
    // clocks that differ.
    const Instant heard = std::max(mission_run.running_since.value_or(Instant{}),
                                   me_.liveness().last_sign_of_kind(kWorld).value_or(Instant{}));
    const double unheard_s = std::chrono::duration<double>(now - heard).count();
    lead += static_cast<Tick>(2 * unheard_s * timing.realtime_factor / timing.dt_s);
  }
  const Tick current = me_.counted(tick) + 1;
  return lead + (author.active_until < 0 ? current
                                         : std::min(current, me_.counted(author.active_until) + 1));
}

void Agent::on(const Contribution& theirs, const Arrival& arrival) {
  InMission* const mission_run = in_mission();
  if (mission_run == nullptr) return;
  const RosterEntry* entry = me_.member(theirs.header);
  if (entry == nullptr) return;  // not a member as far as we know
  if (arrival.transmitter != theirs.header.sender) {
    mission_run->anti_entropy.on_relayed(theirs, mission_run->table);
  }
  ++status_.contributions_received;
  const std::int64_t limit = max_steps(*mission_run, *entry, arrival.now);
  // Before our first tick we do not know the mission's time. The count may be right, so it is
  // ignored and not counted as refused.
  if (mission_run->step.tick < 0 && theirs.steps > limit) return;
  switch (mission_run->table.merge(theirs, limit)) {
    case Merge::kRefusedRange:
      return count_refused(Refusal::kRange);
    case Merge::kRefusedLimit:
      return count_refused(Refusal::kLimit);
    case Merge::kRefusedEncoding:
      return count_refused(Refusal::kEncoding);
    case Merge::kNewer:
      mission_run->table.set_quality(theirs.author(), mission_run->sensors.of(entry->kind).quality);
      mission_run->last_update[theirs.author()] = mission_run->step.counted;
      return;
    case Merge::kStale:
      return;
  }
}

void Agent::on(const Digest& theirs, const Arrival& arrival) {
  InMission* const mission_run = in_mission();
  if (mission_run == nullptr || !arrival.fresh || me_.member(theirs.header) == nullptr) return;
  mission_run->anti_entropy.on(theirs, mission_run->table, follower().roster(), arrival.now,
                               mission_run->step.counted);
}

void Agent::on(const Beacon& beacon, const Arrival& arrival) {
  InMission* const mission_run = in_mission();
  if (mission_run == nullptr || !mission_run->beacons) return;
  mission_run->beacons->receive(beacon, arrival.fresh, {mission_run->step.tick, arrival.now});
}

void Agent::on(const WorldState& world, const Arrival& arrival) {
  InMission* const mission_run = in_mission();
  if (mission_run == nullptr) return;
  Step& step = mission_run->step;
  radio_.on(world);
  if (mission_run->forecast && world.header.tick >= mission_run->active_from)
    note_places(*mission_run, world);
  if (mission_run->separation) mission_run->bodies.see(world);
  for (int i = 0; i < world.vehicle_count; ++i) {
    const Vehicle& vehicle = world.vehicles[static_cast<std::size_t>(i)];
    if (vehicle.id != me_.id()) continue;
    // The world repeats for the logger a state from before our admission. Our predecessor drove
    // then.
    if (world.header.tick < mission_run->active_from && vehicle.answered_tick > step.answered)
      return;
    if (!mission_run->separation && !mission().domain.contains(vehicle.position_m)) {
      return count_refused(Refusal::kRange);
    }
    const Tick newest = mission_run->pending ? mission_run->pending->tick : step.tick;
    if (world.header.tick < newest) return;
    if (world.header.tick == step.tick) {
      step.repeat_wanted = step.repeat_wanted || arrival.fresh;
      return;
    }
    mission_run->pending =
        WorldView{world.header.tick, world.roster_revision, vehicle.answered_tick,
                  vehicle.position_m, vehicle.velocity_mps};
  }
}

// ---- acting ----

void Agent::advance(Instant now, Outbox& out) {
  ask_for_admission(now, out);
  if (phase() == AgentPhase::kRunning) advance_mission(*in_mission(), now, out);
  if (!finished() && mission_repeat_.due(now)) repeat_mission(now, out);
  if (InMission* const mission_run = in_mission()) {
    answer_digests(*mission_run, now, out);
    if (mission_run->next_status.due(now, mission_run->step.tick))
      publish_status(*mission_run, now, out);
  }
  if (auto* const end = std::get_if<Finished>(&state_)) {
    std::move(end->final_messages.begin(), end->final_messages.end(), std::back_inserter(out));
    end->final_messages.clear();
  }
}

void Agent::ask_for_admission(Instant now, Outbox& out) {
  if (!may_ask() || now < hellos_.next) return;
  hellos_ = {now + kHelloPeriod, now, follower().newest_heard()};
  const Hello hello{{}, me_.id(), status_.host, version_, hellos_.revision, kind_};
  me_.publish(Bus::kSwarm, hello, 0, out);
}

/// It also repeats before its admission: it may be the only process left that knows the mission.
void Agent::repeat_mission(Instant now, Outbox& out) {
  mission_repeat_.done(now);
  for (const MissionPart& part : follower().parts()) {
    for (const Bus bus : {Bus::kSwarm, Bus::kCommand}) out.push_back({bus, part});
  }
}

Instant Agent::next_wakeup() const {
  if (finished()) return Instant::max();
  const Instant next = std::min(may_ask() ? hellos_.next : Instant::max(), mission_repeat_.next());
  const auto* const mission_run = std::get_if<InMission>(&state_);
  if (mission_run == nullptr) return next;
  return std::min({next, mission_run->next_status.at, mission_run->next_digest.at,
                   mission_run->anti_entropy.next_answer()});
}

/// Only an admitted agent sends final messages. Two processes that still join may ask for one id,
/// and receivers could not distinguish them.
void Agent::finish(bool failed, std::string reason, bool send_zero_velocity) {
  if (finished()) return;
  Finished end{failed, std::move(reason), {}, {}};
  if (InMission* const mission_run = in_mission()) {
    if (send_zero_velocity) {  // the vehicle's last command: its driver may not know STOP
      mission_run->last_command.position_m = mission_run->step.x_m;
      mission_run->last_command.velocity_mps.setZero();
      me_.publish(Bus::kCommand, mission_run->last_command, mission_run->step.tick,
                  end.final_messages);
    }
    me_.publish(Bus::kSwarm, status_of(*mission_run, AgentPhase::kFinished),
                std::max<Tick>(mission_run->step.tick, 0), end.final_messages);
    end.mission = std::move(*mission_run);
  }
  state_ = std::move(end);
}

// ---- status ----

AgentPhase Agent::phase() const {
  if (finished()) return AgentPhase::kFinished;
  const auto* const mission_run = std::get_if<InMission>(&state_);
  if (mission_run == nullptr) return AgentPhase::kJoining;
  return mission_run->running_since ? AgentPhase::kRunning : AgentPhase::kWaiting;
}

/// The phase that its status reports: phase(), refined by whether it returns home or rests.
AgentPhase Agent::phase_in(const InMission& mission_run) const {
  const AgentPhase phase = this->phase();
  if (phase != AgentPhase::kRunning || !mission_run.way_home) return phase;
  if (rests(mission(), me_.id(), mission_run.step.counted)) return AgentPhase::kResting;
  return mission_run.way_home->begun() ? AgentPhase::kReturning : phase;
}

bool Agent::failed() const {
  const auto* const end = std::get_if<Finished>(&state_);
  return end != nullptr && end->failed;
}

const std::string& Agent::reason() const {
  static const std::string kNone;
  const auto* const end = std::get_if<Finished>(&state_);
  return end == nullptr ? kNone : end->reason;
}

const Coefficients& Agent::team_coverage() const {
  if (mission_run() == nullptr) return kNoCoverage;
  mission_run()->table.average(mission_run()->team_coverage);
  return mission_run()->team_coverage;
}

const Coefficients& Agent::foreseen_coverage() const {
  return mission_run() == nullptr ? kNoCoverage : mission_run()->foreseen;
}

/// How many messages of members were lost on the swarm bus.
std::int64_t Agent::lost() const {
  std::int64_t lost = 0;
  for (const RosterEntry& entry : follower().roster()) {
    lost += me_.liveness().lost(entry.author, Bus::kSwarm);
  }
  return lost;
}

/// Counted ticks since the oldest of the teammates' last updates.
Tick Agent::oldest_update_age(const InMission& mission_run) const {
  Tick oldest = 0;
  for (const RosterEntry& entry : follower().roster()) {
    if (entry.author == me_.author() || !entry.active_at(mission_run.step.tick)) continue;
    if (rests(mission(), entry.author.agent, mission_run.step.counted)) continue;
    const Tick* const last_update = mission_run.last_update.find(entry.author);
    const Tick last = last_update == nullptr ? -1 : *last_update;
    const Tick joined = me_.counted(entry.active_from);
    oldest = std::max(oldest, mission_run.step.counted - std::max(last, joined - 1));
  }
  return oldest;
}

AgentStatus Agent::status_of(const InMission& mission_run, AgentPhase phase) {
  AgentStatus status = status_;
  status_.loop_lag_s = 0;
  status.phase = phase;
  if (mission_run.step.tick >= 0) {
    status.ergodic_metric = mission_run.controller.metric(team_coverage());
    status.max_staleness_s =
        static_cast<double>(oldest_update_age(mission_run)) * mission().timing.dt_s;
  }
  status.waiting_for = mission_run.step.waiting_for;
  status.answered_tick = mission_run.step.answered;
  status.contributions_lost = lost();
  status.messages_sent = me_.sent();
  status.messages_received = me_.received();
  status.contributions_relayed = mission_run.anti_entropy.relayed();
  status.refused = me_.refused();
  return status;
}

void Agent::publish_status(InMission& mission_run, Instant now, Outbox& out) {
  AgentStatus status = status_of(mission_run, phase_in(mission_run));
  const auto since = mission_run.running_since;
  if (since && me_.silent(kWorld, now, *since)) status.waiting_for = kWorld;
  me_.publish(Bus::kSwarm, status, std::max<Tick>(mission_run.step.tick, 0), out);
  mission_run.next_status = Deadline::in(kAgentStatusPeriod, now, kStatusMissionPeriod_s,
                                         mission().timing.dt_s, mission_run.step.tick);
}

std::string Agent::blocked_reason() const {
  if (finished()) return "";
  if (follower().revision() < 0) return "no coordinator answers";
  const std::string as_agent = "admitted as agent " + std::to_string(me_.id()) + ", waiting for ";
  if (phase() == AgentPhase::kWaiting) return as_agent + "the quorum";
  if (phase() == AgentPhase::kRunning) return tick() < 0 ? as_agent + "the world" : "";
  const auto& roster = follower().roster();
  const bool taken = std::any_of(roster.begin(), roster.end(), [this](const RosterEntry& entry) {
    return entry.author.agent == requested_id_ && entry.active_until < 0;
  });
  if (!taken) return "waiting to be admitted";
  return "waiting to be admitted: the roster has another agent " + std::to_string(requested_id_) +
         ", whose end the coordinator may not have noticed yet";
}

}  // namespace ergocast
