#include "agent/agent.h"

#include <algorithm>
#include <chrono>
#include <limits>

#include "core/require.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

constexpr auto kHelloPeriod = 250ms;
/// A status this often in mission time too, so that a fast lockstep run is not left unobserved.
constexpr double kStatusMissionPeriod_s = 1.0;
/// How far ahead of us a teammate's coverage may be before it counts as forged.
constexpr double kLead_s = 60;
constexpr Tick kLeadTicks = 64;
/// Statuses of another process under our id before we believe that it lives.
constexpr int kRivalStatuses = 3;

}  // namespace

Agent::Agent(AgentIdentity identity, PlanDecoder decode_plan)
    : identity_(std::move(identity)), follower_(std::move(decode_plan)) {
  ERGOCAST_REQUIRE(identity_.incarnation != 0);
  self_ = {identity_.requested_id, identity_.incarnation};
}

void Agent::receive(const Message& message, Instant) {
  const Header& from = header_of(message);
  if (finished() || from.incarnation == identity_.incarnation) return;
  if (identity_.run != 0 && from.run != identity_.run) return count_refused(Refusal::kRun);
  ++received_;
  if (const auto* m = std::get_if<Contribution>(&message)) return on(*m);
  if (const auto* m = std::get_if<WorldState>(&message)) return on(*m);
  if (const auto* m = std::get_if<MissionPart>(&message)) return on(*m);
  if (const auto* m = std::get_if<AgentStatus>(&message)) return on(*m);
  if (const auto* m = std::get_if<Stop>(&message)) return on(*m);
}

void Agent::on(const MissionPart& part) {
  if (identity_.run == 0) identity_.run = part.header.run;
  if (!follower_.receive(part)) return;
  if (follower_.plan_unreadable()) {
    return finish(true, "the mission plan is not readable by version " + identity_.version +
                            ": run the same version everywhere");
  }
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
  table_.emplace(mission.basis, mission.timing.dt_s);
  controller_.emplace(mission);
  team_coverage_ = Coefficients::Zero(mission.basis.modes_x, mission.basis.modes_y);
  table_->add_row(self_);  // before any other incarnation could take its place
  published_.resize(static_cast<std::size_t>(table_->block_count()));
  phase_ = AgentPhase::kWaiting;
}

void Agent::on(const Contribution& theirs) {
  if (!table_) return;
  const RosterEntry* entry = follower_.entry_of(theirs.header.incarnation);
  if (entry == nullptr || entry->author != theirs.author()) return;  // nobody we know of yet
  Heard& heard = count_heard(theirs.header);
  ++contributions_received_;
  const double dt_s = follower_.mission()->timing.dt_s;
  const Tick lead = std::max(kLeadTicks, static_cast<Tick>(kLead_s / dt_s));
  Tick max_steps = tick_ + 1 + lead;
  if (entry->active_until >= 0) max_steps = std::min(max_steps, entry->active_until + 1);
  if (tick_ < 0 && theirs.steps > max_steps) return;  // we do not know yet how late it is
  switch (table_->merge(theirs, max_steps)) {
    case Merge::kRefusedRange: return count_refused(Refusal::kRange);
    case Merge::kRefusedLimit: return count_refused(Refusal::kLimit);
    case Merge::kNewer: heard.news_tick = tick_; return;
    case Merge::kStale: return;
  }
}

Agent::Heard& Agent::count_heard(const Header& from) {
  Heard& heard = heard_[{from.sender, from.incarnation}];
  if (heard.count == 0) heard.first = from.sequence;
  heard.last = std::max(heard.last, from.sequence);
  ++heard.count;
  return heard;
}

void Agent::on(const AgentStatus& status) {
  if (table_ && follower_.entry_of(status.header.incarnation) != nullptr) {
    count_heard(status.header);
  }
  if (phase_ != AgentPhase::kJoining || identity_.requested_id == kUnassigned ||
      status.header.sender != identity_.requested_id ||
      status.header.sequence <= rival_sequence_) {
    return;
  }
  rival_sequence_ = status.header.sequence;
  if (++rival_statuses_ >= kRivalStatuses) {
    finish(true, "agent " + std::to_string(identity_.requested_id) + " is already running on " +
                     status.host + ": choose another id, or none");
  }
}

void Agent::on(const WorldState& world) {
  if (!follower_.mission() || phase_ == AgentPhase::kJoining) return;
  for (int i = 0; i < world.vehicle_count; ++i) {
    const Vehicle& vehicle = world.vehicles[static_cast<std::size_t>(i)];
    if (vehicle.id != self_.agent) continue;
    if (!follower_.mission()->domain.contains(vehicle.position_m.head<2>())) {
      return count_refused(Refusal::kRange);
    }
    const Tick newest = pending_ ? pending_->tick : tick_;
    if (world.header.tick < newest) return;
    if (world.header.tick == tick_) {
      repeat_wanted_ = true;
      return;
    }
    pending_ = WorldView{world.header.tick, world.roster_revision, vehicle.position_m};
  }
}

void Agent::on(const Stop& stop) { finish(stop.failed, stop.reason); }

void Agent::advance(Instant now, Outbox& out) {
  const bool may_ask = phase_ == AgentPhase::kJoining && identity_.run != 0;
  if (may_ask && now >= next_hello_) {
    next_hello_ = now + kHelloPeriod;
    publish(Bus::kSwarm, Hello{{}, identity_.requested_id, identity_.host, identity_.version}, 0,
            out);
  }
  if (phase_ == AgentPhase::kRunning) {
    if (pending_) begin_tick(out);
    if (repeat_wanted_) repeat(out);
    if (phase_ == AgentPhase::kRunning && answered_tick_ < tick_ && may_answer()) answer(out);
  }
  // Nobody can tell two joining processes apart by an id that neither has been given.
  const bool has_id = table_.has_value();
  if (has_id && (now >= next_status_ || tick_ >= next_status_tick_)) publish_status(now, out);
}

void Agent::begin_tick(Outbox& out) {
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
  roster_revision_ = view.roster_revision;
  x_m_ = view.position_m.head<2>();
  basis_at_.emplace(x_m_, mission.domain, mission.basis);
  table_->add_sample(self_, *basis_at_);
  if (tick_ >= next_broadcast_tick_) broadcast(out);
}

Tick Agent::next_broadcast_after(Tick tick) const {
  const Mission& mission = *follower_.mission();
  const Tick period = mission.timing.broadcast_period_ticks;
  const Tick team = std::max<Tick>(1, static_cast<Tick>(mission.starts_m.size()));
  const Tick phase = self_.agent * period / team % period;
  const Tick since = ((tick - phase) % period + period) % period;
  return tick + period - since;
}

void Agent::broadcast(Outbox& out) {
  next_broadcast_tick_ = next_broadcast_after(tick_);
  for (int b = 0; b < table_->block_count(); ++b) {
    Contribution& block = published_[static_cast<std::size_t>(b)];
    block = table_->block(self_, b);
    block.next_broadcast_tick = next_broadcast_tick_;
    publish(Bus::kSwarm, block, tick_, out);
  }
}

void Agent::repeat(Outbox& out) {
  repeat_wanted_ = false;
  // The blocks as they were broadcast: newer sums would make a tick depend on what was lost.
  for (const Contribution& block : published_) {
    if (block.steps > 0) publish(Bus::kSwarm, block, tick_, out);
  }
  if (answered_tick_ == tick_) publish(Bus::kCommand, last_command_, tick_, out);
}

bool Agent::may_answer() {
  waiting_for_ = kUnassigned;
  if (follower_.mission()->timing.pace == Pace::kRealtime) return true;
  // Who takes part in a tick is what the world says, not who has heard of it first.
  if (follower_.revision() < roster_revision_) return false;
  for (const RosterEntry& entry : follower_.roster()) {
    if (entry.author == self_ || !entry.active_at(tick_)) continue;
    if (!table_->holds_due(entry.author, tick_)) {
      waiting_for_ = entry.author.agent;
      return false;
    }
  }
  return true;
}

void Agent::answer(Outbox& out) {
  table_->average(team_coverage_);
  const Eigen::Vector2d velocity =
      controller_->command(self_.agent, tick_, x_m_, *basis_at_, team_coverage_);
  last_command_.position_m << x_m_, 0;
  last_command_.velocity_mps << velocity, 0;
  answered_tick_ = tick_;
  publish(Bus::kCommand, last_command_, tick_, out);
}

void Agent::publish_status(Instant now, Outbox& out) {
  AgentStatus status;
  status.phase = phase_;
  if (tick_ >= 0) status.ergodic_metric = controller_->metric(team_coverage_);
  status.max_staleness_s = max_staleness_s();
  status.waiting_for = waiting_for_;
  status.answered_tick = answered_tick_;
  status.contributions_received = contributions_received_;
  status.contributions_lost = messages_lost();
  status.messages_sent = sequencer_.total();
  status.messages_received = received_;
  status.missed_ticks = missed_ticks_;
  status.refused = refused_;
  status.kernel_drops = kernel_drops_;
  status.host = identity_.host;
  publish(Bus::kSwarm, status, std::max<Tick>(tick_, 0), out);
  next_status_ = now + kAgentStatusPeriod;
  const double dt_s = follower_.mission()->timing.dt_s;
  next_status_tick_ = tick_ + std::max<Tick>(1, static_cast<Tick>(kStatusMissionPeriod_s / dt_s));
  if (!finished()) return;
  next_status_ = Instant::max();
  next_status_tick_ = std::numeric_limits<Tick>::max();
}

double Agent::max_staleness_s() const {
  if (tick_ < 0) return 0;
  Tick oldest = 0;
  for (const RosterEntry& entry : follower_.roster()) {
    if (entry.author == self_ || !entry.active_at(tick_)) continue;
    const auto heard = heard_.find(entry.author);
    const Tick news = heard == heard_.end() ? -1 : heard->second.news_tick;
    oldest = std::max(oldest, tick_ - std::max(news, entry.active_from - 1));
  }
  return static_cast<double>(oldest) * follower_.mission()->timing.dt_s;
}

std::int64_t Agent::messages_lost() const {
  std::int64_t lost = 0;
  for (const auto& [author, heard] : heard_) lost += heard.lost();
  return lost;
}

Instant Agent::next_wakeup() const {
  if (finished()) return Instant::max();
  if (phase_ != AgentPhase::kJoining) return next_status_;
  return identity_.run == 0 ? Instant::max() : next_hello_;
}

void Agent::finish(bool failed, std::string reason) {
  phase_ = AgentPhase::kFinished;
  failed_ = failed;
  reason_ = std::move(reason);
  next_status_ = Instant{};  // the last status says that it has finished
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
