// SPDX-License-Identifier: BSD-3-Clause
// Joins the mission, follows its state, and ends it.
#include "agent/agent.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <utility>

#include "core/base/require.h"
#include "core/mission/sites.h"
#include "core/motion/vehicle.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

constexpr auto kHelloPeriod = 250ms;
/// A newer roster makes the next HELLO due at once, because HELLO must name it. This is the
/// shortest time between two.
constexpr auto kHelloGap = 10ms;
/// How long another process must send under our id before we conclude that it runs. Repeats of a
/// stopped process do not deceive the coordinator: it would have admitted us by then.
constexpr auto kDuplicateIdPatience = 5s;

const Coefficients kNoCoverage;

}  // namespace

Agent::Agent(AgentIdentity identity, LawMaker laws)
    : me_(kRole, {identity.run, identity.requested_id, identity.incarnation}),
      requested_id_(identity.requested_id),
      version_(std::move(identity.version)),
      kind_(std::move(identity.kind)),
      laws_(std::move(laws)),
      mission_repeat_(identity.incarnation) {
  ERGOCAST_REQUIRE(identity.incarnation != 0);
  status_.host = std::move(identity.host);
}

void Agent::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  if (finished()) return;
  // A message from out of range counts as never received.
  if (in_mission() && !in_mission()->receives(transmitter, me_)) return;
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
}

const MissionRun* Agent::mission_run() const {
  const auto* end = std::get_if<Finished>(&state_);
  if (end == nullptr) return in_mission();
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
  if (mission().sites.any()) return finish(true, kSitesAreSimulated);
  if (follower().over()) {
    return finish(follower().state() == MissionState::kFailed, follower().reason());
  }
  if (auto why = why_not_of_kind(mission(), kind_, requested_id_))
    return finish(true, *std::move(why));
  if (in_mission()) in_mission()->note_roster(me_);
  const RosterEntry* own = own_entry();
  if (own == nullptr && number_is_closed()) return finish(false, kSentOut);
  if (own == nullptr) return;
  if (auto over = MissionRun::evicted(me_, std::max<Tick>(tick(), 0)))
    return finish(over->failed, std::move(over->reason));
  if (!in_mission()) {
    me_.set_id(own->author.agent);
    state_.emplace<MissionRun>(me_, *own, laws_);
  }
  if (follower().state() == MissionState::kRunning) in_mission()->start(arrival.now);
}

/// Whether the agent with its number was sent out of the mission. No other agent follows it.
bool Agent::number_is_closed() const {
  return std::ranges::any_of(follower().roster(), [this](const RosterEntry& entry) {
    return entry.author.agent == requested_id_ && entry.leaves;
  });
}

void Agent::on(const Hello& hello, const Arrival& arrival) {
  if (!me_.knows_mission() || !arrival.fresh) return;
  if (hello.header.sender == kWorld && in_mission())
    in_mission()->asked_by(hello.header.incarnation);
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

// ---- acting ----

void Agent::advance(Instant now, Outbox& out) {
  ask_for_admission(now, out);
  if (phase() == AgentPhase::kRunning) {
    auto over = in_mission()->advance(me_, now, out);
    if (over) finish(over->failed, std::move(over->reason), over->stops_vehicle);
  }
  if (!finished() && mission_repeat_.due(now)) repeat_mission(now, out);
  if (MissionRun* const run = in_mission()) {
    run->help(me_, now, out);
    if (run->status_due(now)) run->publish_status(take_process_status(), me_, now, out);
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
  return in_mission() ? std::min(next, in_mission()->next_wakeup()) : next;
}

/// Only an admitted agent sends final messages. Two processes that still join may ask for one id,
/// and receivers could not distinguish them.
void Agent::finish(bool failed, std::string reason, bool send_zero_velocity) {
  if (finished()) return;
  Finished end{failed, std::move(reason), {}, {}};
  if (MissionRun* const run = in_mission()) {
    if (send_zero_velocity) run->stop_vehicle(me_, end.final_messages);
    run->publish_last_status(take_process_status(), me_, end.final_messages);
    end.mission = std::move(*run);
  }
  state_ = std::move(end);
}

// ---- what others may know ----

/// What its status has of the process.
AgentStatus Agent::take_process_status() {
  AgentStatus status = status_;
  status_.loop_lag_s = 0;
  return status;
}

AgentPhase Agent::phase() const {
  if (finished()) return AgentPhase::kFinished;
  if (!in_mission()) return AgentPhase::kJoining;
  return in_mission()->started() ? AgentPhase::kRunning : AgentPhase::kWaiting;
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
  return mission_run() ? mission_run()->team_coverage() : kNoCoverage;
}

const Coefficients& Agent::foreseen_coverage() const {
  return mission_run() ? mission_run()->foreseen_coverage() : kNoCoverage;
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
         "; if that one has stopped, the coordinator has not noticed it yet";
}

}  // namespace ergocast
