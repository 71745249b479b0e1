// SPDX-License-Identifier: BSD-3-Clause
// Passes messages on to the parts that decide, and sends what follows.
#include "coordinator/coordinator.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <utility>

#include "coordinator/recalling.h"
#include "core/base/require.h"
#include "core/mission/end_by_finding.h"
#include "plan/plan.h"
#include "team/median_metric.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

constexpr auto kTeamStatusPeriod = 250ms;

}  // namespace

const char* to_string(MemberState member_state) {
  constexpr const char* kNames[] = {"alive", "silent", "gone"};
  return kNames[static_cast<int>(member_state)];
}

MemberState Coordinator::member_state(const RosterEntry& entry, Instant now) const {
  if (entry.active_until >= 0) return MemberState::kGone;
  return signs_at(now).alive(entry) ? MemberState::kAlive : MemberState::kSilent;
}

Coordinator::Coordinator(CoordinatorIdentity identity, std::vector<std::byte> plan,
                         Takeover takeover)
    : me_(kRole, {identity.run, kCoordinator, identity.incarnation}),
      host_(std::move(identity.host)),
      plan_(std::move(plan)),
      search_(takeover),
      admission_(std::move(identity.version)) {
  if (!plan_.empty()) mission_ = decode_plan(plan_).value();
  ERGOCAST_REQUIRE(mission_ || takeover == Takeover::kMust);
}

// ---- messages ----

void Coordinator::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  // While it knows no run, it receives only the status of a coordinator, of any run, because it
  // would disturb that one.
  const bool knows_run = me_.run() != 0 || learns_run(message);
  if (!knows_run && !std::holds_alternative<TeamStatus>(message)) return;
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
}

/// The search finds a run by an agent that takes part in it.
bool Coordinator::learns_run(const Message& message) {
  const auto* status = std::get_if<AgentStatus>(&message);
  if (!looking() || status == nullptr) return false;
  if (status->phase != AgentPhase::kWaiting && !answers_ticks(status->phase)) return false;
  me_.set_run(status->header.run);
  return me_.run() != 0;
}

void Coordinator::on(const Hello& hello, const Arrival& arrival) {
  const Instant now = arrival.now;
  const Header& from = hello.header;
  if (looking()) return;
  if (from.sender >= kUnassigned) admission_.note_stranger(from.incarnation, members_, now);
  if (is_over(state_)) return;
  if (from.sender == kWorld) {
    if (arrival.fresh) ticks_.receive_question(hello, now);
    return;
  }
  if (!admission_.suits(hello, *mission_)) return;
  if (members_.contains(from.incarnation)) return announcement_.repeat_soon();
  const SignsOfLife signs = signs_at(now);
  note_silences(members_, signs, announcement_);
  const auto newcomer = admission_.admitted(hello, *mission_, members_, signs, announcement_);
  if (newcomer) admit(*newcomer, now);
}

void Coordinator::on(const AgentStatus& status, const Arrival& arrival) {
  const Header& from = status.header;
  if (looking()) return ticks_.note_agent(from.tick);
  const Author author{from.sender, from.incarnation};
  Member* member = members_.find(author);
  if (member == nullptr || !arrival.fresh) return;
  member->status = status;
  ticks_.note_agent(std::min(from.tick, end_tick()));
  const bool leaves = status.phase == AgentPhase::kFinished && state_ == MissionState::kRunning &&
                      from.tick < end_tick();
  RosterEntry* entry = members_.active_entry(from.sender);
  if (!leaves || entry == nullptr || entry->author != author) return;
  entry->active_until = std::max(tick(), from.tick);
  announcement_.change();
}

void Coordinator::on(const MissionPart& part, const Arrival& arrival) {
  if (looking()) {
    if (arrival.mission_changed) search_.note_mission(arrival.now);
    return;
  }
  // If two coordinators took over at once, one stays.
  const Incarnation theirs = part.header.incarnation;
  if (std::pair(part.revision, theirs) <= std::pair(announcement_.revision(), me_.incarnation()))
    return;
  if (other_coordinator_.alive_as(theirs, signs_at(arrival.now))) {
    return leave("another coordinator has taken the mission over", arrival.now);
  }
  // An agent repeated a revision of a coordinator that is gone. The team must accept our revisions
  // again.
  if (arrival.mission_changed) {
    amending_.adopt(me_.follower().amendments());
    adopt_recalls(me_.follower().roster(), members_);
  }
  announcement_.exceed(part.revision);
}

void Coordinator::on(const WorldState& world, const Arrival& arrival) {
  const Instant now = arrival.now;
  other_coordinator_.note_world(world.roster_revision, announcement_.revision(), now);
  if (looking()) return ticks_.note_world(world.header.tick);
  if (arrival.fresh) ending_.note_world(world.last);
  places_.note_world(world);
  const bool is_newest = ticks_.receive(world, now);
  const SignsOfLife signs = signs_at(now);
  amending_.note_world(*mission_, ticks_, team_at(signs), announcement_);
  found_ |= world.found;
  if (is_newest && state_ == MissionState::kRunning)
    amending_.note_found(std::popcount(world.found), std::popcount(found_), *mission_, ticks_,
                         signs, announcement_);
  if (is_newest && tick() >= end_tick())
    end(false, why_complete(mission_->objects, std::popcount(found_)), now);
}

void Coordinator::on(const RecordAck& ack, const Arrival& arrival) {
  if (!arrival.fresh) return;
  ending_.note_logger(ack.last);
  for (const Find& find : ack.all_finds()) found_ |= ObjectSet{1} << find.object;
}

void Coordinator::on(const TeamStatus& theirs, const Arrival& arrival) {
  if (arrival.fresh) other_coordinator_.receive(theirs);
}

/// While it searches for the mission, it does not know yet which ticks are old. The operator
/// repeats STOP.
void Coordinator::on(const Stop& stop, const Arrival& arrival) {
  if (looking()) return;
  end(stop.failed, stop.reason, arrival.now);
}

void Coordinator::on(const Amend& amend, const Arrival& arrival) {
  if (looking() || state_ != MissionState::kRunning) return;
  const SignsOfLife signs = signs_at(arrival.now);
  amending_.obey(amend, *mission_, ticks_, team_at(signs), announcement_);
}

void Coordinator::on(const Recall& recall, const Arrival&) {
  if (looking() || state_ != MissionState::kRunning) return;
  obey(recall, members_, announcement_);
}

// ---- time ----

void Coordinator::advance(Instant now, Outbox& out) {
  if (finished()) return;
  if (looking()) look_for_mission(now, out);
  if (!looking() && !finished()) lead(now, out);
}

Instant Coordinator::next_wakeup() const {
  if (looking()) return search_.next_look(other_coordinator_, me_.follower());
  if (!leads_since_) return Instant{};
  return std::min(announcement_.next(), next_team_status_);
}

void Coordinator::end(bool failed, std::string reason, Instant now) {
  if (!ending_.begin(std::move(reason), now)) return;
  state_ = failed ? MissionState::kFailed : MissionState::kEnded;
  announcement_.change();
}

// ---- takeover ----

void Coordinator::look_for_mission(Instant now, Outbox& out) {
  if (ending_.begun()) return ending_.finish();  // the operator stops it before it leads a mission
  switch (search_.look(other_coordinator_, signs_at(now))) {
    case MissionSearch::Outcome::kFound:
      return take_over(now);
    case MissionSearch::Outcome::kNoMission:
      return begin_own();
    case MissionSearch::Outcome::kLedByOther:
      return leave(other_coordinator_.why_not_ours(), now);
    case MissionSearch::Outcome::kNoAnswer:
      leave("no agent on this URL knows a mission to take over", now);
      break;
    case MissionSearch::Outcome::kNone:
      break;
  }
  if (search_.is_question_due(now) && me_.run() != 0) me_.publish(Bus::kSwarm, Hello{}, -1, out);
}

void Coordinator::take_over(Instant now) {
  const MissionFollower& known = me_.follower();
  const auto problem = search_.why_not(plan_, other_coordinator_, signs_at(now));
  search_.end();
  if (problem) return leave(*problem, now);
  taken_over_ = true;
  mission_ = known.mission();
  plan_ = known.plan();
  state_ = known.state();
  ending_.take_over(known, now);
  // What an operator wants and no tick was named for lapses: the operator repeats it.
  amending_.plan(known.amendments());
  // The world may have stopped, too. Then the tick of the predecessor or of the agents counts.
  for (const MissionPart& part : known.parts()) ticks_.note_world(part.header.tick);
  ticks_.take_over(end_tick(), now);
  announcement_.continue_from(first_revision(known, tick()));
  for (const RosterEntry& entry : known.roster()) {
    members_.add(entry);
    me_.presume_alive(entry.author, now);
  }
}

void Coordinator::begin_own() {
  search_.end();
  me_.set_run(me_.incarnation());
}

/// Finishes at once and silently: the mission is not ours to end.
void Coordinator::leave(std::string reason, Instant now) {
  end(true, std::move(reason), now);
  ending_.leave();
}

// ---- the mission ----

void Coordinator::lead(Instant now, Outbox& out) {
  if (!leads_since_) leads_since_ = now;
  const SignsOfLife signs = signs_at(now);
  note_silences(members_, signs, announcement_);
  const auto other = other_coordinator_.revision_to_exceed(announcement_.revision(), signs);
  if (other) announcement_.exceed(*other);
  if (state_ == MissionState::kRunning) {
    end_departed(ticks_.newest(), signs, members_, announcement_);
    coverage_review_.review(*mission_, ticks_, members_, signs, announcement_);
  }
  if (state_ == MissionState::kWaiting) check_admission(now);
  if (state_ == MissionState::kRunning && timing().pace == Pace::kLockstep) check_tick(now);
  if (state_ == MissionState::kWaiting) start_with_quorum(now);
  publish_due(now, out);
  if (!ending_.begun()) return;
  // A process that asks to join must receive the end, too.
  const bool all_left =
      !admission_.is_asked(kEndLinger, now) && ending_.all_have_left(members_, signs);
  if (all_left) publish_mission(out);  // once more, for those that only watch
  if (all_left || ending_.over(now)) ending_.finish();
}

void Coordinator::admit(const Newcomer& newcomer, Instant now) {
  const Author& author = newcomer.author;
  if (!members_.have_room(author.agent)) return;
  if (RosterEntry* former = members_.active_entry(author.agent)) {
    former->active_until = ticks_.newest();
  }
  RosterEntry entry{author, state_ == MissionState::kRunning ? ticks_.newest() : 0, -1};
  entry.kind = newcomer.kind;
  if (const RosterEntry* recalled = members_.recalled_entry(author.agent))
    entry.recall_revision = recalled->recall_revision;
  members_.add(entry);
  me_.presume_alive(author, now);
  admission_.forget(author.incarnation);
  ticks_.give_full_time(now);  // the tick also waits for the newcomer
  announcement_.note_admission();
}

void Coordinator::check_admission(Instant now) {
  if (now - *leads_since_ < seconds(timing().admission_timeout_s)) return;
  const SignsOfLife signs = signs_at(now);
  std::string missing;
  for (AgentId id = 0; id < static_cast<AgentId>(mission_->starts_m.size()); ++id) {
    const RosterEntry* entry = members_.active_entry(id);
    if (entry != nullptr && signs.alive(*entry)) continue;
    missing += (missing.empty() ? "" : ", ") + std::to_string(id);
  }
  end(true,
      "only " + std::to_string(members_.alive_count(signs)) + " of the quorum of " +
          std::to_string(mission_->quorum) + " agents were admitted; missing: " + missing,
      now);
}

void Coordinator::check_tick(Instant now) {
  const auto overdue = ticks_.overdue(timing(), members_, signs_at(now));
  if (!overdue) return;
  RosterEntry* const late = overdue->straggler;
  if (late == nullptr || timing().on_timeout == OnTimeout::kEndMission) {
    return end(true, overdue->sentence, now);
  }
  late->active_until = tick();
  ticks_.give_full_time(now);
  announcement_.change();
}

void Coordinator::start_with_quorum(Instant now) {
  if (members_.alive_count(signs_at(now)) < mission_->quorum) return;
  state_ = MissionState::kRunning;
  ticks_.give_full_time(now);
  announcement_.change();
}

void Coordinator::publish_due(Instant now, Outbox& out) {
  // This comes first, so that a coordinator that yields to our mission knows that we are alive.
  if (now >= next_team_status_) {
    publish_team_status(now, out);
    next_team_status_ = now + kTeamStatusPeriod;
  }
  if (now >= announcement_.next()) {
    publish_mission(out);
    announcement_.plan_next(ending_.begun(), now);
  }
}

void Coordinator::publish_mission(Outbox& out) {
  const MissionContent content{state_,   reason(),          plan_,
                               members_, amending_.bytes(), amending_.stand_by_revision()};
  announcement_.publish(content, me_, tick(), out);
}

void Coordinator::publish_team_status(Instant now, Outbox& out) {
  const SignsOfLife signs = signs_at(now);
  std::vector<const AgentStatus*> statuses;
  std::size_t present = 0;
  TeamStatus team;
  for (const RosterEntry& entry : roster()) {
    if (entry.active_until >= 0) continue;
    ++present;
    const auto& status = members_.at(entry.author).status;
    if (status) statuses.push_back(&*status);
    if (signs.alive(entry)) {
      ++team.agents_alive;
    } else if (team.silent_agent == kUnassigned) {
      team.silent_agent = entry.author.agent;
    }
  }
  team.state = state_;
  team.tick_count = tick_count();
  team.missed_deadlines = ticks_.missed_deadlines();
  team.paused = paused();
  team.agents_expected = static_cast<std::int32_t>(std::max(present, mission_->starts_m.size()));
  team.ergodic_metric = median_metric(statuses).value_or(0);
  team.host = host_;
  me_.publish(Bus::kSwarm, team, tick(), out);
}

}  // namespace ergocast
