#include "agent/agent.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include "core/noise.h"
#include "core/require.h"
#include "team/silence.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

constexpr auto kHelloPeriod = 250ms;
/// At once when it hears of a newer roster, which it must name, but not more often.
constexpr auto kHelloGap = 10ms;
/// This often in mission time too, so that a fast lockstep run is not left alone.
constexpr double kStatusMissionPeriod_s = 1.0;
constexpr auto kDigestPeriod = 1s;
constexpr double kDigestMissionPeriod_s = 1.0;
/// Whoever asks for the mission gets it from one of us, after a random share of this; and from each
/// of us at most so often, or where an old one is heard, which may be a recording, so often.
constexpr auto kLongestRepeatDelay = 50ms;
constexpr auto kAnswerGap = 100ms;
constexpr auto kCorrectionGap = 500ms;
/// A world that says nothing for so long is worth a word.
constexpr auto kWorldSilence = 1s;
/// How far ahead of us a teammate's coverage may be before it counts as forged.
constexpr double kLead_s = 60;
constexpr Tick kLeadTicks = 64;
/// How long another process speaks under our id before we believe that it lives: the coordinator,
/// who is not deceived by repeats of what a dead one said, would have admitted us by then.
constexpr auto kRivalPatience = 5s;

}  // namespace

Agent::Agent(AgentIdentity identity) : identity_(std::move(identity)) {
  ERGOCAST_REQUIRE(identity_.incarnation != 0);
  self_ = {identity_.requested_id, identity_.incarnation};
  last_command_.header.tick = command_before_.header.tick = -1;
}

void Agent::receive(const Message& message, Instant now, AgentId transmitter) {
  const Header& from = header_of(message);
  if (finished() || from.incarnation == identity_.incarnation) return;
  if (identity_.run != 0 && from.run != identity_.run) return count_refused(Refusal::kRun);
  if (!radio_.hears(self_.agent, transmitter)) return;
  ++received_;
  if (const auto* m = std::get_if<Contribution>(&message)) return on(*m, transmitter, now);
  if (const auto* m = std::get_if<WorldState>(&message)) return on(*m, now);
  if (const auto* m = std::get_if<Digest>(&message)) return on(*m, now);
  if (const auto* m = std::get_if<Hello>(&message)) return on(*m, now);
  if (const auto* m = std::get_if<MissionPart>(&message)) return on(*m, now);
  if (const auto* m = std::get_if<AgentStatus>(&message)) return on(*m, now);
  // Of a run that it does not know, it may be the end of a former one, said again.
  if (const auto* m = std::get_if<Stop>(&message); m && identity_.run != 0) return on(*m);
}

void Agent::on(const MissionPart& part, Instant now) {
  if (identity_.run == 0) identity_.run = part.header.run;
  if (freshness_.is_news(part.header)) coordinator_heard_ = now;
  // Said by somebody else; or by one who has not heard of what came later, or will not be heard.
  // That is believed twice only: it may be a recording of one part.
  if (part.revision >= follower_.revision() && mission_repeat_ && ++repeats_left_to_others_ <= 2) {
    mission_repeat_.reset();
  }
  if (part.revision < follower_.revision()) plan_mission_repeat(now, kCorrectionGap);
  const std::int64_t foreign_plans = follower_.foreign_plans();
  const std::int64_t heard_before = follower_.newest_heard();
  const bool news = follower_.receive(part);
  if (follower_.newest_heard() > heard_before) {
    next_hello_ = std::min(next_hello_, std::max(now, last_hello_ + kHelloGap));
  }
  if (follower_.foreign_plans() != foreign_plans) count_refused(Refusal::kRange);
  if (!news) return;
  if (follower_.plan_problem()) return finish(true, *follower_.plan_problem());
  if (follower_.over()) {
    return finish(follower_.state() == MissionState::kFailed, follower_.reason());
  }
  const RosterEntry* own = follower_.entry_of(identity_.incarnation);
  if (own == nullptr) return;
  if (evicted(std::max<Tick>(tick_, 0))) return;
  if (phase_ == AgentPhase::kJoining) {
    self_ = own->author;
    join();
  }
  if (phase_ == AgentPhase::kWaiting && follower_.state() == MissionState::kRunning) {
    phase_ = AgentPhase::kRunning;
    world_heard_ = now;
  }
}

bool Agent::evicted(Tick tick) {
  const RosterEntry* own = follower_.entry_of(identity_.incarnation);
  if (own == nullptr || own->active_until < 0 || own->active_until > tick) return false;
  finish(true, "evicted from the roster at tick " + std::to_string(own->active_until));
  return true;
}

void Agent::join() {
  const Mission& mission = *follower_.mission();
  active_from_ = follower_.entry_of(identity_.incarnation)->active_from;
  table_.emplace(mission.basis, mission.timing.dt_s, active_from_);
  controller_.emplace(mission);
  if (mission.law.anticipation > 0) forecast_.emplace(mission, self_);
  anti_entropy_.emplace(self_, mission.seed, mission.timing.dt_s);
  radio_ = RadioRange(mission.radio_range_m);
  team_coverage_ = foreseen_ = Coefficients::Zero(mission.basis.modes_x, mission.basis.modes_y);
  table_->add_row(self_);  // before any other incarnation could take its place
  published_.resize(static_cast<std::size_t>(table_->block_count()));
  phase_ = AgentPhase::kWaiting;
}

/// Whose word it is, if it is that of a member, present or former, under its own number.
const RosterEntry* Agent::member(const Header& from) const {
  const RosterEntry* entry = follower_.entry_of(from.incarnation);
  return entry != nullptr && entry->author.agent == from.sender ? entry : nullptr;
}

std::int64_t Agent::most_steps(const RosterEntry& author, Instant now) const {
  const Timing& timing = follower_.mission()->timing;
  Tick lead = std::max(kLeadTicks, static_cast<Tick>(kLead_s / timing.dt_s));
  if (timing.pace == Pace::kRealtime && tick_ >= 0) {
    // Others have gone on while we heard nothing of the world; twice, for clocks that differ.
    const double unheard_s = std::chrono::duration<double>(now - world_heard_).count();
    lead += static_cast<Tick>(2 * unheard_s * timing.realtime_factor / timing.dt_s);
  }
  const Tick current = tick_ + 1;
  return lead + (author.active_until < 0 ? current : std::min(current, author.active_until + 1));
}

void Agent::on(const Contribution& theirs, AgentId transmitter, Instant now) {
  if (!table_) return;
  const RosterEntry* entry = member(theirs.header);
  if (entry == nullptr) return;  // nobody we know of yet
  if (transmitter == theirs.header.sender) {
    hearing_.count(theirs.header);
  } else {
    anti_entropy_->on_relayed(theirs, *table_);
  }
  ++contributions_received_;
  const std::int64_t max_steps = most_steps(*entry, now);
  if (tick_ < 0 && theirs.steps > max_steps) return;  // we do not know yet how late it is
  switch (table_->merge(theirs, max_steps)) {
    case Merge::kRefusedRange: return count_refused(Refusal::kRange);
    case Merge::kRefusedLimit: return count_refused(Refusal::kLimit);
    case Merge::kNewer: return hearing_.news(theirs.author(), tick_);
    case Merge::kStale: return;
  }
}

void Agent::on(const Digest& theirs, Instant now) {
  if (!table_ || member(theirs.header) == nullptr) return;
  hearing_.count(theirs.header);
  if (!freshness_.is_news(theirs.header)) return;
  anti_entropy_->on(theirs, *table_, follower_.roster(), now, tick_);
}

void Agent::on(const Hello& hello, Instant now) {
  if (!follower_.mission()) return;
  if (!freshness_.is_news(hello.header)) return;
  if (hello.header.sender == kWorld && table_) world_asks_ = hello.header.incarnation;
  const bool knows_no_mission = hello.header.sender < kUnassigned && hello.header.tick < 0;
  if (knows_no_mission) plan_mission_repeat(now, kAnswerGap);
}

void Agent::plan_mission_repeat(Instant now, PacingClock::duration gap) {
  if (mission_repeat_) return;
  if (mission_repeated_ && now - *mission_repeated_ < gap) return;
  const double share = uniform_pair(identity_.incarnation, Purpose::kAnswer, 0,
                                    static_cast<std::uint64_t>(received_)).x();
  mission_repeat_ = now + std::chrono::duration_cast<PacingClock::duration>(share * kLongestRepeatDelay);
}

void Agent::on(const AgentStatus& status, Instant now) {
  if (table_ && member(status.header) != nullptr) hearing_.count(status.header);
  if (phase_ != AgentPhase::kJoining || identity_.requested_id == kUnassigned ||
      status.header.sender != identity_.requested_id || !freshness_.is_news(status.header)) {
    return;
  }
  if (!rival_since_) rival_since_ = now;
  if (now - *rival_since_ >= kRivalPatience) {
    finish(true, "agent " + std::to_string(identity_.requested_id) + " is already running on " +
                     status.host + ": choose another id, or none");
  }
}

void Agent::on(const WorldState& world, Instant now) {
  if (!follower_.mission() || phase_ == AgentPhase::kJoining) return;
  const bool is_news = freshness_.is_news(world.header);
  if (is_news) world_heard_ = now;
  radio_.on(world);
  if (forecast_ && world.header.tick >= active_from_) note_places(world);
  for (int i = 0; i < world.vehicle_count; ++i) {
    const Vehicle& vehicle = world.vehicles[static_cast<std::size_t>(i)];
    if (vehicle.id != self_.agent) continue;
    // From before we were admitted, repeated for the logger: our predecessor drove then.
    if (world.header.tick < active_from_ && vehicle.answered_tick > answered_tick_) return;
    if (!follower_.mission()->domain.contains(vehicle.position_m.head<2>())) {
      return count_refused(Refusal::kRange);
    }
    const Tick newest = pending_ ? pending_->tick : tick_;
    if (world.header.tick < newest) return;
    if (world.header.tick == tick_) {
      repeat_wanted_ = repeat_wanted_ || is_news;
      return;
    }
    pending_ = WorldView{world.header.tick, world.roster_revision, vehicle.position_m};
  }
}

/// Where the others are, as far as they are heard. Nobody drives a vehicle whose answers have stopped
/// for as long as the world goes on with an old one; in lockstep the world waits for them.
void Agent::note_places(const WorldState& world) {
  const Timing& timing = follower_.mission()->timing;
  const Tick tick = world.header.tick;
  if (tick > places_tick_) {
    places_tick_ = tick;
    places_parts_.reset();
  }
  if (tick == places_tick_ && static_cast<std::size_t>(world.part) < places_parts_.size()) {
    places_parts_.set(static_cast<std::size_t>(world.part));
    places_wanted_ = static_cast<std::size_t>(world.parts);
  }
  const auto hold = static_cast<Tick>(std::max(1.0, std::ceil(timing.command_hold_s / timing.dt_s)));
  for (int i = 0; i < world.vehicle_count; ++i) {
    const Vehicle& vehicle = world.vehicles[static_cast<std::size_t>(i)];
    if (!radio_.hears(self_.agent, vehicle.id)) continue;
    if (timing.pace == Pace::kRealtime && vehicle.answered_tick < tick - hold) continue;
    forecast_->see(vehicle.id, tick, vehicle.position_m.head<2>());
  }
}

void Agent::on(const Stop& stop) {
  if (!stop.now) return;  // the coordinator ends the mission for all of us
  halted_ = phase_ == AgentPhase::kRunning && tick_ >= 0;
  finish(stop.failed, stop.reason);
}

void Agent::advance(Instant now, Outbox& out) {
  // A coordinator that was restarted may not know of us any more: then we ask again.
  const bool may_ask = !finished() && identity_.run != 0 && !admitted();
  if (may_ask && now >= next_hello_) {
    last_hello_ = now;
    next_hello_ = now + kHelloPeriod;
    const Hello hello{{}, self_.agent, identity_.host, identity_.version, follower_.newest_heard()};
    publish(Bus::kSwarm, hello, 0, out);
  }
  if (phase_ == AgentPhase::kRunning) {
    if (pending_) begin_tick(now, out);
    if (repeat_wanted_) repeat(out);
    if (phase_ == AgentPhase::kRunning && answered_tick_ < tick_ && may_answer()) answer(out);
  }
  if (phase_ == AgentPhase::kRunning && stalled(now)) {
    stalled_said_ = now;
    broadcast(out);
  }
  if (phase_ == AgentPhase::kRunning && abandoned(now)) {
    finish(true, "neither the world nor the coordinator can be heard, and the mission must be over by "
                 "now: check this host's network");
  }
  if (halted_) stand_still(out);
  if (!finished() && mission_repeat_ && now >= *mission_repeat_) repeat_mission(now, out);
  // Nobody can tell two joining processes apart by an id that neither has been given.
  if (!table_) return;
  if (!finished()) help_others(now, out);
  if (next_status_.due(now, tick_)) publish_status(now, out);
}

void Agent::help_others(Instant now, Outbox& out) {
  if (world_asks_) tell_world(out);
  for (Contribution& block : anti_entropy_->answers_due(*table_, now, tick_)) {
    block.header.run = identity_.run;
    out.push_back({Bus::kSwarm, block, self_.agent});
  }
  if (!next_digest_.due(now, tick_)) return;
  const double dt_s = follower_.mission()->timing.dt_s;
  next_digest_ = Deadline::in(kDigestPeriod, now, kDigestMissionPeriod_s, dt_s, tick_);
  for (const Digest& digest : AntiEntropy::digests(*table_, follower_.roster())) {
    publish(Bus::kSwarm, digest, std::max<Tick>(tick_, 0), out);
  }
}

/// Also before it is admitted: it may be the only one left who knows the mission.
void Agent::repeat_mission(Instant now, Outbox& out) {
  mission_repeat_.reset();
  repeats_left_to_others_ = 0;
  mission_repeated_ = now;
  for (const MissionPart& part : follower_.parts()) {
    for (const Bus bus : {Bus::kSwarm, Bus::kCommand}) out.push_back({bus, part});
  }
}

void Agent::tell_world(Outbox& out) {
  for (Command command : {command_before_, last_command_}) {
    command.asked_by = *world_asks_;
    publish(Bus::kCommand, command, command.header.tick, out);
  }
  world_asks_.reset();
}

/// The last word to the vehicle, whose driver may know no STOP.
void Agent::stand_still(Outbox& out) {
  halted_ = false;
  last_command_.position_m << x_m_, 0;
  last_command_.velocity_mps.setZero();
  publish(Bus::kCommand, last_command_, tick_, out);
}

void Agent::begin_tick(Instant now, Outbox& out) {
  const Mission& mission = *follower_.mission();
  const WorldView view = *pending_;
  pending_.reset();
  repeat_wanted_ = false;
  if (view.tick >= mission.timing.tick_count) {
    tick_ = view.tick;
    return finish(false, "mission complete");
  }
  if (evicted(view.tick)) return;
  if (tick_ >= 0) missed_ticks_ += view.tick - tick_ - 1;
  tick_ = view.tick;
  tick_begun_ = now;
  roster_revision_ = view.roster_revision;
  x_m_ = view.position_m.head<2>();
  basis_at_.emplace(x_m_, mission.domain, mission.basis);
  // A restarted world may be a tick behind the roster: our predecessor has covered that tick.
  if (tick_ < active_from_) return;
  table_->add_sample(self_, *basis_at_);
  if (tick_ >= next_broadcast_tick_) broadcast(out);
}

/// Whether the ticks have stopped coming: then what we have is said now and then without waiting for
/// more. In lockstep nobody may hear of a tick before the broadcast that was announced.
bool Agent::stalled(Instant now) const {
  return follower_.mission()->timing.pace == Pace::kRealtime && tick_ >= active_from_ &&
         now - std::max(tick_begun_, stalled_said_) >= kWorldSilence;
}

bool Agent::abandoned(Instant now) const {
  return must_be_over(follower_.mission()->timing, tick_,
                      now - std::max(world_heard_, coordinator_heard_));
}

void Agent::broadcast(Outbox& out) {
  next_broadcast_tick_ = next_broadcast(*follower_.mission(), self_.agent, tick_);
  for (int b = 0; b < table_->block_count(); ++b) {
    Contribution& block = published_[static_cast<std::size_t>(b)];
    block = table_->block(self_, b);
    block.header.tick = tick_;  // a repeat says it, too: forecasts count a block's age from it
    block.next_broadcast_tick = next_broadcast_tick_;
    publish(Bus::kSwarm, block, tick_, out);
  }
}

void Agent::repeat(Outbox& out) {
  repeat_wanted_ = false;
  // The blocks as they were broadcast: newer sums would make a tick depend on what was lost.
  for (const Contribution& block : published_) {
    if (block.steps > 0) publish(Bus::kSwarm, block, block.header.tick, out);
  }
  if (answered_tick_ == tick_) publish(Bus::kCommand, last_command_, tick_, out);
}

/// Whether all parts of the tick's WORLD_STATE are there: what a command depends on is the same for
/// whoever hears them in another order.
bool Agent::knows_places() const {
  if (!forecast_ || !follower_.mission()->dead_reckoning || tick_ < active_from_) return true;
  return places_tick_ > tick_ || places_parts_.count() >= places_wanted_;
}

bool Agent::may_answer() {
  waiting_for_ = kUnassigned;
  if (follower_.mission()->timing.pace == Pace::kRealtime) return true;
  if (!knows_places()) {
    waiting_for_ = kWorld;
    return false;
  }
  // Who takes part in a tick is what the world says, not who has heard of it first.
  if (follower_.revision() < roster_revision_) return false;
  for (const RosterEntry& entry : follower_.roster()) {
    if (entry.author == self_ || !entry.active_at(tick_)) continue;
    if (!radio_.hears(self_.agent, entry.author.agent)) continue;
    if (!table_->holds_due(entry.author, tick_)) {
      waiting_for_ = entry.author.agent;
      return false;
    }
  }
  return true;
}

void Agent::answer(Outbox& out) {
  // By the roster that the tick may have waited for.
  for (const RosterEntry& entry : follower_.roster()) {
    // What we cover ourselves counts: we live, whatever the coordinator has heard.
    const bool forgotten = entry.author != self_ && entry.forgotten_at(tick_, roster_revision_);
    forgotten ? table_->forget(entry.author) : table_->remember(entry.author);
  }
  if (forecast_) {
    forecast_->look_ahead(*table_, follower_.roster(), tick_, foreseen_);
  } else {
    table_->average(foreseen_);
  }
  controller_->see(foreseen_);
  const Eigen::Vector2d velocity =
      controller_->command(self_.agent, tick_, x_m_, *basis_at_);
  command_before_ = last_command_;
  last_command_.header.tick = tick_;
  last_command_.position_m << x_m_, 0;
  last_command_.velocity_mps << velocity, 0;
  answered_tick_ = tick_;
  publish(Bus::kCommand, last_command_, tick_, out);
}

const Coefficients& Agent::team_coverage() const {
  if (table_) table_->average(team_coverage_);
  return team_coverage_;
}

void Agent::publish_status(Instant now, Outbox& out) {
  AgentStatus status;
  status.phase = phase_;
  if (tick_ >= 0) status.ergodic_metric = controller_->metric(team_coverage());
  const double dt_s = follower_.mission()->timing.dt_s;
  if (tick_ >= 0) {
    status.max_staleness_s =
        static_cast<double>(hearing_.oldest_news(follower_.roster(), self_, tick_)) * dt_s;
  }
  const bool world_is_silent = phase_ == AgentPhase::kRunning && now - world_heard_ > kWorldSilence;
  status.waiting_for = world_is_silent ? kWorld : waiting_for_;
  status.answered_tick = answered_tick_;
  status.contributions_received = contributions_received_;
  status.contributions_lost = hearing_.lost();
  status.messages_sent = sequencer_.total();
  status.messages_received = received_;
  status.contributions_relayed = anti_entropy_->relayed();
  status.missed_ticks = missed_ticks_;
  status.refused = refused_;
  status.babbler = babbler_;
  status.kernel_drops = kernel_drops_;
  status.loop_lag_s = std::exchange(loop_lag_s_, 0);
  status.host = identity_.host;
  publish(Bus::kSwarm, status, std::max<Tick>(tick_, 0), out);
  next_status_ = Deadline::in(kAgentStatusPeriod, now, kStatusMissionPeriod_s, dt_s, tick_);
  if (finished()) next_status_ = {Instant::max(), std::numeric_limits<Tick>::max()};
}

std::string Agent::obstacle() const {
  if (finished()) return "";
  if (follower_.revision() < 0) return "no coordinator is heard";
  const std::string as_agent = "admitted as agent " + std::to_string(self_.agent) + ", waiting for ";
  if (phase_ == AgentPhase::kWaiting) return as_agent + "the quorum";
  if (phase_ == AgentPhase::kRunning) return tick_ < 0 ? as_agent + "the world" : "";
  const auto& roster = follower_.roster();
  const bool taken = std::any_of(roster.begin(), roster.end(), [this](const RosterEntry& entry) {
    return entry.author.agent == identity_.requested_id && entry.active_until < 0;
  });
  if (!taken) return "waiting to be admitted";
  return "waiting to be admitted: the roster has another agent " +
         std::to_string(identity_.requested_id) + ", which may have died and not be missed yet";
}

Instant Agent::next_wakeup() const {
  if (finished()) return Instant::max();
  Instant next = identity_.run != 0 && !admitted() ? next_hello_ : Instant::max();
  if (mission_repeat_) next = std::min(next, *mission_repeat_);
  if (!table_) return next;
  return std::min({next, next_status_.at, next_digest_.at, anti_entropy_->next_answer()});
}

void Agent::finish(bool failed, std::string reason) {
  phase_ = AgentPhase::kFinished;
  failed_ = failed;
  reason_ = std::move(reason);
  next_status_ = {};  // the last status says that it has finished
}

Header Agent::header(Bus bus, Tick tick) {
  return {identity_.run, self_.agent, identity_.incarnation, sequencer_.next(bus), tick};
}

template <class M>
void Agent::publish(Bus bus, const M& message, Tick tick, Outbox& out) {
  // Copied once, into its place: a contribution is a kilobyte.
  Outgoing& outgoing = out.emplace_back();
  outgoing.bus = bus;
  outgoing.message.emplace<M>(message).header = header(bus, tick);
}

}  // namespace ergocast
