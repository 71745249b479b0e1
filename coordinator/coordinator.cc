// SPDX-License-Identifier: BSD-3-Clause
// Admits agents into the roster, repeats the mission until it ends, and removes or reports members
// that do not answer.
#include "coordinator/coordinator.h"

#include <algorithm>
#include <chrono>
#include <iterator>
#include <numeric>
#include <sstream>
#include <utility>

#include "core/require.h"
#include "team/plan.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

constexpr auto kMissionPeriod = 1s;
constexpr auto kMissionGap = 100ms;
constexpr auto kTeamStatusPeriod = 250ms;
/// A message of an agent that is older than this is out of date.
constexpr auto kOverdue = kAgentStatusPeriod * 3 / 2;
/// How long the end is repeated.
constexpr auto kLinger = 1s;

}  // namespace

const char* to_string(MemberState member_state) {
  constexpr const char* kNames[] = {"alive", "silent", "gone"};
  return kNames[static_cast<int>(member_state)];
}

MemberState Coordinator::member_state(const RosterEntry& entry, Instant now) const {
  if (entry.active_until >= 0) return MemberState::kGone;
  return alive(entry, now) ? MemberState::kAlive : MemberState::kSilent;
}

Coordinator::Coordinator(CoordinatorIdentity identity, std::vector<std::byte> plan,
                         Takeover takeover)
    : me_(kRole, {identity.run, kCoordinator, identity.incarnation}),
      name_{std::move(identity.host), std::move(identity.version)},
      led_{{}, std::move(plan)},
      search_{takeover, {}, {}} {
  if (!led_.plan.empty()) led_.mission = std::get<Mission>(decode_plan(led_.plan));
  ERGOCAST_REQUIRE(led_.mission || takeover == Takeover::kMust);
}

void Coordinator::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  if (me_.run() == 0) {
    const auto* status = std::get_if<AgentStatus>(&message);
    const bool flying = status != nullptr &&
                        (status->phase == AgentPhase::kWaiting || answers_ticks(status->phase));
    if (looking() && flying) me_.set_run(status->header.run);
    // While it searches, it knows no run. It receives only the status of a coordinator, of any run,
    // because it would disturb that one.
    if (me_.run() == 0 && !std::holds_alternative<TeamStatus>(message)) return;
  }
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
}

/// While it searches for the mission, it does not know yet which ticks are old. The operator
/// repeats STOP.
void Coordinator::on(const Stop& stop, const Arrival& arrival) {
  if (looking()) return;
  end(stop.failed, stop.reason, arrival.now);
}

void Coordinator::on(const AgentStatus& status, const Arrival& arrival) {
  if (looking()) {
    team_tick_ = std::max(team_tick_, status.header.tick);
    return;
  }
  const auto at = members_.find({status.header.sender, status.header.incarnation});
  if (at == members_.end() || !arrival.fresh) return;
  at->second.status = status;
  team_tick_ = std::max(team_tick_, std::min(status.header.tick, end_tick()));
  RosterEntry* entry = active_entry(status.header.sender);
  const bool leaves = status.phase == AgentPhase::kFinished && state_ == MissionState::kRunning &&
                      status.header.tick < end_tick();
  if (!leaves || entry == nullptr || entry->author != at->first) return;
  entry->active_until = std::max(world_.tick, status.header.tick);
  change();
}

/// A starting world asks the team for its state; meanwhile the tick gets its full time again.
void Coordinator::on_question(const Hello& question, const Arrival& arrival) {
  if (!arrival.fresh) return;
  if (question.header.incarnation != world_.begun) world_.tick_since = arrival.now;
  world_.begun = question.header.incarnation;
  world_.unheard = question.requested_id;
  world_.asked = arrival.now;
}

void Coordinator::on(const WorldState& world, const Arrival& arrival) {
  const Instant now = arrival.now;
  note_revision(world, now);
  if (looking()) {
    world_.tick = std::max(world_.tick, world.header.tick);
    return;
  }
  world_.heard = true;
  if (arrival.fresh) world_.left = world.last;
  if (world.header.tick < world_.tick) return;
  if (world.header.tick > world_.tick) world_.tick_since = now;
  world_.tick = world.header.tick;
  world_.revision = world.roster_revision;
  const bool stands = stand_by_revision_ >= 0 && world_.revision >= stand_by_revision_;
  // The world goes on once it knows the named tick. No agent answers the next tick before that.
  if (stands) name_tick(world_.tick + 2);
  world_.missed_deadlines = std::max(world_.missed_deadlines, world.missed_deadlines);
  for (int i = 0; i < world.vehicle_count; ++i) {
    const Vehicle& vehicle = world.vehicles[static_cast<std::size_t>(i)];
    Tick& answered = world_.answered.try_emplace(vehicle.id, -1).first->second;
    answered = std::max(answered, vehicle.answered_tick);
  }
  if (world_.tick >= end_tick()) end(false, "mission complete", now);
}

void Coordinator::note_revision(const WorldState& world, Instant now) {
  if (world.roster_revision <= revisions_.current) return;
  world_.newest_revision = std::max(world_.newest_revision, world.roster_revision);
  if (!world_.newer_since) world_.newer_since = now;
}

void Coordinator::on(const RecordAck& ack, const Arrival& arrival) {
  if (arrival.fresh) ending_.logger_left = ack.last;
}

bool Coordinator::alive(const RosterEntry& entry, Instant now) const {
  return entry.active_until < 0 && !me_.silent(entry.author, now);
}

Instant Coordinator::last_sign(const Author& author) const {
  return me_.liveness().last_sign(author).value_or(Instant{});
}

int Coordinator::alive_count(Instant now) const {
  return static_cast<int>(std::count_if(roster_.begin(), roster_.end(),
                                        [&](const RosterEntry& e) { return alive(e, now); }));
}

void Coordinator::end(bool failed, std::string reason, Instant now) {
  if (ending_.since) return;
  state_ = failed ? MissionState::kFailed : MissionState::kEnded;
  ending_.reason = std::move(reason);
  ending_.since = now;
  change();
}

AgentId Coordinator::waits_for(const RosterEntry& entry) const {
  const auto at = members_.find(entry.author);
  return at != members_.end() && at->second.status ? at->second.status->waiting_for : kUnassigned;
}

RosterEntry* Coordinator::straggler(Instant now) {
  // A restarted world lacks the answers that the former incarnation may have received.
  const bool asks = now - world_.asked <= kOverdue;
  RosterEntry* unheard = asks ? active_entry(world_.unheard) : nullptr;
  if (unheard != nullptr) return unheard;
  RosterEntry* silent = nullptr;
  RosterEntry* suspect = nullptr;
  for (RosterEntry& entry : roster_) {
    if (entry.active_until >= 0 || world_.answered[entry.author.agent] >= world_.tick) continue;
    const Instant heard = last_sign(entry.author);
    if (now - heard > kOverdue) {
      if (silent == nullptr || heard < last_sign(silent->author)) silent = &entry;
      continue;
    }
    // A member that waits for a teammate is no straggler. That teammate is one, unless it waits
    // itself.
    const AgentId teammate = waits_for(entry);
    RosterEntry* named = teammate == kUnassigned ? nullptr : active_entry(teammate);
    if (named != nullptr && waits_for(*named) == kUnassigned) {
      suspect = named;
    } else if (suspect == nullptr) {
      suspect = &entry;
    }
  }
  return silent != nullptr ? silent : suspect;
}

void Coordinator::check_admission(Instant now) {
  if (now - *schedule_.first < seconds(timing().admission_timeout_s)) return;
  std::string missing;
  for (AgentId id = 0; id < static_cast<AgentId>(led_.mission->starts_m.size()); ++id) {
    const RosterEntry* entry = active_entry(id);
    if (entry != nullptr && alive(*entry, now)) continue;
    missing += (missing.empty() ? "" : ", ") + std::to_string(id);
  }
  end(true,
      "only " + std::to_string(alive_count(now)) + " of the quorum of " +
          std::to_string(led_.mission->quorum) + " agents were admitted; missing: " + missing,
      now);
}

void Coordinator::check_tick(Instant now) {
  if (now - world_.tick_since < seconds(timing().lockstep_timeout_s)) return;
  RosterEntry* late = straggler(now);
  std::ostringstream since_text;
  since_text << " for " << timing().lockstep_timeout_s << " s";
  const std::string since = since_text.str();
  if (late == nullptr) {
    if (alive_count(now) == 0) {
      return end(true, "no agent is left to answer tick " + std::to_string(world_.tick), now);
    }
    return end(true,
               world_.heard
                   ? "the world has not gone beyond tick " + std::to_string(world_.tick) + since
                   : "no world answered" + since + ": is one running on this URL?",
               now);
  }
  const std::string who = "agent " + std::to_string(late->author.agent) +
                          " has not answered tick " + std::to_string(world_.tick) + since;
  if (timing().on_timeout == OnTimeout::kEndMission) return end(true, who, now);
  late->active_until = world_.tick;
  world_.tick_since = now;
  change();
}

/// A member's silence makes a new revision: its number may go to a newcomer that has received that
/// revision.
void Coordinator::note_silences(Instant now) {
  for (const RosterEntry& entry : roster_) {
    if (entry.active_until >= 0) continue;
    Member& member = members_[entry.author];
    const bool silent = !alive(entry, now);
    if (silent && !member.silence_reported) {
      publish_anew();
      member.silence_revision = revisions_.current;
    }
    member.silence_reported = silent;
  }
}

/// Coverage under a number stops counting after the plan's time without a message under that
/// number. It counts again after the next one.
void Coordinator::review_coverage(Instant now) {
  if (led_.mission->forget_silent_after_s <= 0) return;
  // Without any live member the coordinator may be cut off itself, so it concludes nothing from
  // silence.
  if (alive_count(now) == 0) deaf_until_ = now;
  const auto patience = std::max(seconds(led_.mission->forget_silent_after_s), silence_of(0));
  struct Number {
    Instant heard{};
    bool speaks = false;
  };
  std::map<AgentId, Number> numbers;
  for (const auto& [author, member] : members_) {
    Number& number = numbers[author.agent];
    number.heard = std::max(number.heard, last_sign(author));
    number.speaks |= member.status && !me_.silent(author, now);
  }
  for (RosterEntry& entry : roster_) {
    const Number& number = numbers[entry.author.agent];
    const bool silent = now - std::max(number.heard, deaf_until_) >= patience;
    const bool other = entry.forgotten ? number.speaks : silent;
    if (other && may_switch(entry)) switch_coverage(entry, !entry.forgotten);
  }
}

/// Waits for the previous switch to take effect, because an entry has room for one.
bool Coordinator::may_switch(const RosterEntry& entry) const {
  return world_.tick >= entry.since_tick && world_.revision >= entry.since_revision;
}

/// Real time: the notice that the team gets before a change takes effect.
Tick notice_ticks(const Timing& timing) {
  constexpr double kNotice_s = 2;
  if (timing.pace == Pace::kLockstep) return 0;
  return static_cast<Tick>(kNotice_s * timing.realtime_factor / timing.dt_s);
}

void Coordinator::switch_coverage(RosterEntry& entry, bool forgotten) {
  const Timing& timing = led_.mission->timing;
  change();
  entry.forgotten = forgotten;
  entry.since_tick = world_.tick + 1 + notice_ticks(timing);
  entry.since_revision = revisions_.current;
}

void Coordinator::advance(Instant now, Outbox& out) {
  if (ending_.finished) return;
  if (looking()) look_for_mission(now, out);
  if (!looking() && !ending_.finished) lead(now, out);
}

void Coordinator::lead(Instant now, Outbox& out) {
  if (!schedule_.first) schedule_.first = now;
  note_silences(now);
  supersede_dead_coordinator(now);
  if (state_ == MissionState::kRunning) review_coverage(now);
  if (state_ == MissionState::kWaiting) check_admission(now);
  if (state_ == MissionState::kRunning && timing().pace == Pace::kLockstep) check_tick(now);
  if (state_ == MissionState::kWaiting && alive_count(now) >= led_.mission->quorum) {
    state_ = MissionState::kRunning;
    world_.tick_since = now;
    change();
  }
  // This comes first, so that a coordinator that yields to our mission knows that we are alive.
  if (now >= schedule_.next_team_status) {
    publish_team_status(now, out);
    schedule_.next_team_status = now + kTeamStatusPeriod;
  }
  if (now >= schedule_.next_mission) {
    publish_mission(out);
    schedule_.last_mission = now;
    schedule_.next_mission =
        now + (ending_.since || pages_.behind() ? kMissionGap : kMissionPeriod);
  }
  if (!ending_.since) return;
  const bool all_left = everybody_left(now);
  if (all_left) publish_mission(out);  // once more, for those that only watch
  ending_.finished = all_left || now - *ending_.since >= kLinger;
}

/// Whether world, logger and agents have reported that they leave, and no other process asks to
/// join. Each of them leaves once it has received the end.
bool Coordinator::everybody_left(Instant now) const {
  const auto& strangers = newcomers_.heard;
  if (!world_.left || !ending_.logger_left || strangers.size() >= kMaxRosterEntries) return false;
  if (std::any_of(strangers.begin(), strangers.end(),
                  [now](const auto& stranger) { return now - stranger.second < kLinger; })) {
    return false;
  }
  return me_.team_has_left(
      roster_,
      [&](const Author& author) {
        const auto& status = members_.at(author).status;
        return status && status->phase == AgentPhase::kFinished;
      },
      now);
}

/// A process lacks the newest revision. kMissionGap limits the repetitions, so that HELLO messages
/// cannot flood the bus.
void Coordinator::repeat_mission_soon() {
  schedule_.next_mission = std::min(schedule_.next_mission, schedule_.last_mission + kMissionGap);
}

std::vector<MissionPart> Coordinator::mission_parts() const {
  const auto ceil_div = [](std::size_t a, std::size_t b) { return (a + b - 1) / b; };
  const std::size_t parts =
      std::max({std::size_t{1}, ceil_div(led_.plan.size(), kMaxPlanBytesPerMessage),
                ceil_div(roster_.size(), kMaxRosterEntriesPerMessage),
                ceil_div(holds_.size(), kMaxHoldsPerMessage)});
  std::vector<MissionPart> whole(parts);
  for (std::size_t p = 0; p < parts; ++p) {
    MissionPart& part = whole[p];
    part.revision = revisions_.current;
    part.state = state_;
    part.part = static_cast<std::int32_t>(p);
    part.parts = static_cast<std::int32_t>(parts);
    part.reason = ending_.reason;
    part.stand_by_revision = stand_by_revision_;
    if (p < holds_.size()) part.holds = {holds_[p]};
    const std::size_t first = std::min(p * kMaxPlanBytesPerMessage, led_.plan.size());
    const std::size_t last = std::min(first + kMaxPlanBytesPerMessage, led_.plan.size());
    part.plan.assign(led_.plan.begin() + static_cast<std::ptrdiff_t>(first),
                     led_.plan.begin() + static_cast<std::ptrdiff_t>(last));
  }
  // Entries stay in the order of admission, so that a newcomer changes only one part.
  for (const RosterEntry& entry : roster_) {
    whole[admissions_.at(entry.author) / kMaxRosterEntriesPerMessage].roster.push_back(entry);
  }
  return whole;
}

void Coordinator::publish_mission(Outbox& out) {
  revisions_.admits_from = revisions_.who_may_join;
  std::vector<MissionPart> parts = mission_parts();
  std::vector<std::uint64_t> hashes;
  std::transform(parts.begin(), parts.end(), std::back_inserter(hashes), hash_of);
  const std::uint64_t sum = std::accumulate(hashes.begin(), hashes.end(), std::uint64_t{0});
  for (const std::size_t p : pages_.next(hashes)) {
    parts[p].content_hash = sum;
    for (const Bus bus : {Bus::kSwarm, Bus::kCommand}) {
      me_.publish(bus, parts[p], world_.tick, out);
    }
  }
}

void Coordinator::publish_team_status(Instant now, Outbox& out) {
  TeamStatus team;
  team.state = state_;
  team.tick_count = timing().tick_count;
  team.missed_deadlines = world_.missed_deadlines;
  team.paused = paused();
  team.agents_alive = alive_count(now);
  const auto members = std::count_if(roster_.begin(), roster_.end(), [](const RosterEntry& entry) {
    return entry.active_until < 0;
  });
  team.agents_expected = static_cast<std::int32_t>(
      std::max(members, static_cast<std::ptrdiff_t>(led_.mission->starts_m.size())));
  std::vector<double> metrics;
  for (const RosterEntry& entry : roster_) {
    const auto& status = members_[entry.author].status;
    const bool knows = entry.active_until < 0 && status && status->answered_tick >= 0;
    if (knows) metrics.push_back(status->ergodic_metric);
  }
  if (!metrics.empty()) {
    const auto middle = metrics.begin() + static_cast<std::ptrdiff_t>(metrics.size() / 2);
    std::nth_element(metrics.begin(), middle, metrics.end());
    team.ergodic_metric = *middle;
  }
  const auto silent = std::find_if(roster_.begin(), roster_.end(), [&](const RosterEntry& entry) {
    return entry.active_until < 0 && !alive(entry, now);
  });
  if (silent != roster_.end()) team.silent_agent = silent->author.agent;
  team.host = name_.host;
  me_.publish(Bus::kSwarm, team, world_.tick, out);
}

Instant Coordinator::next_wakeup() const {
  if (looking()) return next_look();
  if (!schedule_.first) return Instant{};
  return std::min(schedule_.next_mission, schedule_.next_team_status);
}

}  // namespace ergocast
