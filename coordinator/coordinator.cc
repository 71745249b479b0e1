#include "coordinator/coordinator.h"

#include <algorithm>
#include <chrono>
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
/// An agent that says nothing for so long is not alive.
constexpr auto kSilence = 6 * kAgentStatusPeriod;
/// What it said before that is out of date.
constexpr auto kOverdue = kAgentStatusPeriod * 3 / 2;
/// How long the end is repeated.
constexpr auto kFarewell = 1s;
/// Real time: how long the team gets to hear of a change before it takes effect.
constexpr double kNotice_s = 2;
constexpr std::size_t kMaxStrangers = 64;

}  // namespace

const char* to_string(Presence presence) {
  constexpr const char* kNames[] = {"alive", "silent", "gone"};
  return kNames[static_cast<int>(presence)];
}

Presence Coordinator::presence(const RosterEntry& entry, Instant now) const {
  if (entry.active_until >= 0) return Presence::kGone;
  return alive(entry, now) ? Presence::kAlive : Presence::kSilent;
}

Coordinator::Coordinator(CoordinatorIdentity identity, std::vector<std::byte> plan,
                         Takeover takeover)
    : run_(identity.run),
      incarnation_(identity.incarnation),
      host_(std::move(identity.host)),
      version_(std::move(identity.version)),
      plan_(std::move(plan)),
      takeover_(takeover) {
  if (!plan_.empty()) mission_ = std::get<Mission>(decode_plan(plan_));
  ERGOCAST_REQUIRE(mission_ || takeover == Takeover::kMust);
}

void Coordinator::receive(const Message& message, Instant now) {
  const Header& from = header_of(message);
  const auto* status = std::get_if<AgentStatus>(&message);
  const bool flying = status != nullptr && (status->phase == AgentPhase::kWaiting ||
                                            status->phase == AgentPhase::kRunning);
  if (takeover_ != Takeover::kNever && run_ == 0 && flying) run_ = from.run;
  // While it knows no run, whoever leads one here leads the one that it would disturb.
  const auto* team = std::get_if<TeamStatus>(&message);
  if (team != nullptr && (run_ == 0 || from.run == run_)) return on(*team, now);
  if (run_ == 0 || from.run != run_) return;
  if (const auto* part = std::get_if<MissionPart>(&message)) return on(*part, now);
  if (const auto* stop = std::get_if<Stop>(&message)) return end(stop->failed, stop->reason, now);
  if (takeover_ != Takeover::kNever) {
    if (std::holds_alternative<WorldState>(message)) tick_ = std::max(tick_, from.tick);
    if (from.sender >= 0) team_tick_ = std::max(team_tick_, from.tick);
    return;
  }
  if (const auto* hello = std::get_if<Hello>(&message)) return on(*hello, now);
  if (const auto* world = std::get_if<WorldState>(&message)) return on(*world, now);
  if (status != nullptr) return on(*status, now);
}

void Coordinator::on(const AgentStatus& status, Instant now) {
  const auto at = members_.find({status.header.sender, status.header.incarnation});
  if (at == members_.end()) return;
  Member& member = at->second;
  // Liveness advances only on what is new: a replay keeps nobody alive.
  if (member.status && member.status->header.sequence >= status.header.sequence) return;
  member.status = status;
  member.heard = now;
  team_tick_ = std::max(team_tick_, std::min(status.header.tick, mission_->timing.tick_count));
  RosterEntry* entry = active_entry(status.header.sender);
  const bool leaves = status.phase == AgentPhase::kFinished && state_ == MissionState::kRunning &&
                      status.header.tick < mission_->timing.tick_count;
  if (!leaves || entry == nullptr || entry->author != at->first) return;
  entry->active_until = std::max(tick_, status.header.tick);
  change();
}

// ---- admission -----------------------------------------------------------------------------------

RosterEntry* Coordinator::active_entry(AgentId id) {
  const auto at = std::find_if(roster_.begin(), roster_.end(), [id](const RosterEntry& entry) {
    return entry.author.agent == id && entry.active_until < 0;
  });
  return at == roster_.end() ? nullptr : &*at;
}

/// Whether a member has said nothing since, and may be dead: soon its number may be free.
bool Coordinator::doubtful(Instant since, Instant now) const {
  return std::any_of(roster_.begin(), roster_.end(), [&](const RosterEntry& entry) {
    return alive(entry, now) && members_.at(entry.author).heard < since;
  });
}

std::optional<AgentId> Coordinator::free_id(Incarnation newcomer, Instant now) {
  // A process that was started again at once is the successor of one that still seems to live.
  if (asked_.size() >= kMaxRosterEntries) {
    asked_.erase(std::min_element(asked_.begin(), asked_.end(), [](const auto& a, const auto& b) {
      return a.second < b.second;
    }));
  }
  const Instant since = asked_.try_emplace(newcomer, now).first->second;
  if (doubtful(since, now)) return std::nullopt;
  for (AgentId id = 0; id < kMaxAgents; ++id) {
    const RosterEntry* holder = active_entry(id);
    if (holder == nullptr || !alive(*holder, now)) return id;
  }
  return std::nullopt;
}

void Coordinator::on(const Hello& hello, Instant now) {
  if (state_ == MissionState::kEnded || state_ == MissionState::kFailed) return;
  const Incarnation nonce = hello.header.incarnation;
  if (nonce == 0 || hello.header.sender < kUnassigned) return;  // nobody's mark, or no agent
  if (hello.requested_id < kUnassigned || hello.requested_id >= kMaxAgents) return;
  if (hello.version != version_) {
    if (strangers_.size() < kMaxStrangers) strangers_.emplace(hello.host, hello.version);
    return;
  }
  const bool known = std::any_of(roster_.begin(), roster_.end(), [nonce](const RosterEntry& entry) {
    return entry.author.incarnation == nonce;
  });
  if (known) {
    // It has not heard: say it again soon, but let nobody's hellos flood the bus.
    next_mission_ = std::min(next_mission_, last_mission_ + kMissionGap);
    return;
  }
  note_silences(now);
  if (hello.revision < admits_from_) {
    // Said before the newest was: by somebody who has yet to hear of it, or a recording.
    next_mission_ = std::min(next_mission_, last_mission_ + kMissionGap);
    return;
  }
  std::optional<AgentId> id = hello.requested_id;
  if (*id == kUnassigned) id = free_id(nonce, now);
  if (!id) return;  // not yet, or the team is full
  if (const RosterEntry* holder = active_entry(*id)) {
    if (alive(*holder, now)) return;  // the younger has to give way
    // The silence of one concerns only who would take its number: where messages are late, members fall
    // silent all the time, and nobody else's HELLO would ever be new enough.
    if (hello.revision < members_[holder->author].silence_revision) {
      next_mission_ = std::min(next_mission_, last_mission_ + kMissionGap);
      return;
    }
  }
  admit({*id, nonce}, now);
}

void Coordinator::admit(const Author& author, Instant now) {
  const auto lives = std::count_if(roster_.begin(), roster_.end(), [&](const RosterEntry& entry) {
    return entry.author.agent == author.agent;
  });
  if (roster_.size() >= kMaxRosterEntries || lives >= kMaxIncarnationsPerAgent) return;
  // The agents may be further than the last state that we heard of a world that is dead by now.
  const Tick newest = std::max(tick_, team_tick_);
  if (RosterEntry* former = active_entry(author.agent)) former->active_until = newest;
  const Tick from = state_ == MissionState::kRunning ? newest : 0;
  roster_.push_back({author, from, -1});
  std::sort(roster_.begin(), roster_.end(),
            [](const RosterEntry& a, const RosterEntry& b) { return a.author < b.author; });
  members_[author].heard = now;
  asked_.erase(author.incarnation);
  announce();
}

void Coordinator::on(const WorldState& world, Instant now) {
  world_heard_ = true;
  if (world.roster_revision > revision_) {
    // A predecessor said it, and of all who live the world alone has heard it: the team waits for
    // that roster, or for a newer one.
    revision_ = world.roster_revision;
    change();
  }
  if (world.header.tick < tick_) return;
  if (world.header.tick > tick_) tick_since_ = now;
  tick_ = world.header.tick;
  world_revision_ = world.roster_revision;
  missed_deadlines_ = std::max(missed_deadlines_, world.missed_deadlines);
  for (int i = 0; i < world.vehicle_count; ++i) {
    const Vehicle& vehicle = world.vehicles[static_cast<std::size_t>(i)];
    Tick& answered = answered_.try_emplace(vehicle.id, -1).first->second;
    answered = std::max(answered, vehicle.answered_tick);
  }
  if (tick_ >= mission_->timing.tick_count) end(false, "mission complete", now);
}

bool Coordinator::alive(const RosterEntry& entry, Instant now) const {
  const auto at = members_.find(entry.author);
  return entry.active_until < 0 && at != members_.end() && now - at->second.heard < kSilence;
}

int Coordinator::alive_count(Instant now) const {
  return static_cast<int>(std::count_if(roster_.begin(), roster_.end(), [&](const RosterEntry& e) {
    return alive(e, now);
  }));
}

void Coordinator::end(bool failed, std::string reason, Instant now) {
  if (ended_) return;
  state_ = failed ? MissionState::kFailed : MissionState::kEnded;
  reason_ = std::move(reason);
  ended_ = now;
  change();
}

AgentId Coordinator::waits_for(const RosterEntry& entry) const {
  const auto at = members_.find(entry.author);
  return at != members_.end() && at->second.status ? at->second.status->waiting_for : kUnassigned;
}

RosterEntry* Coordinator::culprit(Instant now) {
  RosterEntry* silent = nullptr;
  RosterEntry* suspect = nullptr;
  for (RosterEntry& entry : roster_) {
    if (entry.active_until >= 0 || answered_[entry.author.agent] >= tick_) continue;
    const Member& member = members_[entry.author];
    if (now - member.heard > kOverdue) {
      if (silent == nullptr || member.heard < members_[silent->author].heard) silent = &entry;
      continue;
    }
    // Who waits for a teammate is not to blame; that teammate is, unless it waits itself.
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
  if (now - *started_ < seconds(mission_->timing.admission_timeout_s)) return;
  std::string missing;
  for (AgentId id = 0; id < static_cast<AgentId>(mission_->starts_m.size()); ++id) {
    const RosterEntry* entry = active_entry(id);
    if (entry != nullptr && alive(*entry, now)) continue;
    missing += (missing.empty() ? "" : ", ") + std::to_string(id);
  }
  end(true, "only " + std::to_string(alive_count(now)) + " of the quorum of " +
                std::to_string(mission_->quorum) + " agents were admitted; missing: " + missing, now);
}

void Coordinator::check_tick(Instant now) {
  if (now - tick_since_ < seconds(mission_->timing.lockstep_timeout_s)) return;
  RosterEntry* late = culprit(now);
  std::ostringstream since_text;
  since_text << " for " << mission_->timing.lockstep_timeout_s << " s";
  const std::string since = since_text.str();
  if (late == nullptr) {
    if (alive_count(now) == 0) {
      return end(true, "no agent is left to answer tick " + std::to_string(tick_), now);
    }
    return end(true, world_heard_ ? "the world has not gone beyond tick " + std::to_string(tick_) + since
                                  : "no world was heard" + since + ": is one running on this URL?",
               now);
  }
  const std::string who = "agent " + std::to_string(late->author.agent) +
                          " has not answered tick " + std::to_string(tick_) + since;
  if (mission_->timing.on_timeout == OnTimeout::kEndMission) return end(true, who, now);
  late->active_until = tick_;
  tick_since_ = now;
  change();
}

/// Whoever falls silent is news: its number may go to a newcomer that knows of the silence.
void Coordinator::note_silences(Instant now) {
  for (const RosterEntry& entry : roster_) {
    if (entry.active_until >= 0) continue;
    Member& member = members_[entry.author];
    const bool silent = !alive(entry, now);
    if (silent && !member.silence_said) {
      say_anew();
      member.silence_revision = revision_;
    }
    member.silence_said = silent;
  }
}

/// What was covered under a number stops counting once nobody was heard under it for as long as the
/// plan says, and counts again once somebody is.
void Coordinator::review_coverage(Instant now) {
  if (mission_->forget_silent_after_s <= 0) return;
  // Who hears nobody is deaf itself, and learns nothing of others' silence.
  if (alive_count(now) == 0) deaf_until_ = now;
  const auto patience = std::max<PacingClock::duration>(seconds(mission_->forget_silent_after_s), kSilence);
  struct Number {
    Instant heard{};
    bool speaks = false;
  };
  std::map<AgentId, Number> numbers;
  for (const auto& [author, member] : members_) {
    Number& number = numbers[author.agent];
    number.heard = std::max(number.heard, member.heard);
    number.speaks |= member.status && now - member.heard < kSilence;
  }
  for (RosterEntry& entry : roster_) {
    const Number& number = numbers[entry.author.agent];
    const bool silent = now - std::max(number.heard, deaf_until_) >= patience;
    const bool other = entry.forgotten ? number.speaks : silent;
    if (other && may_switch(entry)) switch_coverage(entry, !entry.forgotten);
  }
}

/// Not before the last switch has happened: an entry has room for one.
bool Coordinator::may_switch(const RosterEntry& entry) const {
  return tick_ >= entry.since_tick && world_revision_ >= entry.since_revision;
}

void Coordinator::switch_coverage(RosterEntry& entry, bool forgotten) {
  const Timing& timing = mission_->timing;
  const double notice_s = timing.pace == Pace::kLockstep ? 0 : kNotice_s;
  change();
  entry.forgotten = forgotten;
  entry.since_tick = tick_ + 1 + static_cast<Tick>(notice_s * timing.realtime_factor / timing.dt_s);
  entry.since_revision = revision_;
}

void Coordinator::advance(Instant now, Outbox& out) {
  if (finished_) return;
  if (takeover_ != Takeover::kNever) look_for_mission(now, out);
  if (takeover_ == Takeover::kNever && !finished_) lead(now, out);
}

void Coordinator::lead(Instant now, Outbox& out) {
  if (!started_) started_ = now;
  note_silences(now);
  if (state_ == MissionState::kRunning) review_coverage(now);
  if (state_ == MissionState::kWaiting) check_admission(now);
  if (state_ == MissionState::kRunning && mission_->timing.pace == Pace::kLockstep) check_tick(now);
  if (state_ == MissionState::kWaiting && alive_count(now) >= mission_->quorum) {
    state_ = MissionState::kRunning;
    tick_since_ = now;
    change();
  }
  // First, so that a coordinator whom our mission outranks knows that we live.
  if (now >= next_team_status_) {
    publish_team_status(now, out);
    next_team_status_ = now + kTeamStatusPeriod;
  }
  if (now >= next_mission_) {
    publish_mission(out);
    last_mission_ = now;
    next_mission_ = now + (ended_ ? kMissionGap : kMissionPeriod);
  }
  finished_ = ended_ && now - *ended_ >= kFarewell;
}

void Coordinator::publish_mission(Outbox& out) {
  admits_from_ = who_may_join_;
  const auto ceil_div = [](std::size_t a, std::size_t b) { return (a + b - 1) / b; };
  const std::size_t parts =
      std::max({std::size_t{1}, ceil_div(plan_.size(), kMaxPlanBytesPerMessage),
                ceil_div(roster_.size(), kMaxRosterEntriesPerMessage)});
  for (std::size_t p = 0; p < parts; ++p) {
    MissionPart part;
    part.revision = revision_;
    part.state = state_;
    part.part = static_cast<std::int32_t>(p);
    part.parts = static_cast<std::int32_t>(parts);
    part.reason = reason_;
    const auto slice = [p](const auto& all, std::size_t size, auto& into) {
      const std::size_t first = std::min(p * size, all.size());
      const std::size_t last = std::min(first + size, all.size());
      into.assign(all.begin() + static_cast<std::ptrdiff_t>(first),
                  all.begin() + static_cast<std::ptrdiff_t>(last));
    };
    slice(roster_, kMaxRosterEntriesPerMessage, part.roster);
    slice(plan_, kMaxPlanBytesPerMessage, part.plan);
    for (const Bus bus : {Bus::kSwarm, Bus::kCommand}) {
      part.header = header(bus);
      out.push_back({bus, part});
    }
  }
}

void Coordinator::publish_team_status(Instant now, Outbox& out) {
  TeamStatus team;
  team.state = state_;
  team.tick_count = mission_->timing.tick_count;
  team.missed_deadlines = missed_deadlines_;
  team.agents_alive = alive_count(now);
  const auto members = std::count_if(roster_.begin(), roster_.end(), [](const RosterEntry& entry) {
    return entry.active_until < 0;
  });
  team.agents_expected = static_cast<std::int32_t>(
      std::max(members, static_cast<std::ptrdiff_t>(mission_->starts_m.size())));
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
  team.host = host_;
  team.header = header(Bus::kSwarm);
  out.push_back({Bus::kSwarm, team});
}

Header Coordinator::header(Bus bus) {
  return {run_, kCoordinator, incarnation_, sequencer_.next(bus), tick_};
}

Instant Coordinator::next_wakeup() const {
  if (takeover_ != Takeover::kNever) return next_look();
  if (!started_) return Instant{};
  return std::min(next_mission_, next_team_status_);
}

}  // namespace ergocast
