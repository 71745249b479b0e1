#include "coordinator/coordinator.h"

#include <algorithm>
#include <chrono>
#include <sstream>

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
constexpr std::size_t kMaxRosterEntries = static_cast<std::size_t>(kMaxAgents) * 4;

}  // namespace

Coordinator::Coordinator(RunId run, Incarnation incarnation, Mission mission,
                         std::vector<std::byte> plan)
    : run_(run),
      incarnation_(incarnation),
      mission_(std::move(mission)),
      plan_(std::move(plan)) {}

void Coordinator::receive(const Message& message, Instant now) {
  if (header_of(message).run != run_) return;
  if (const auto* hello = std::get_if<Hello>(&message)) return on(*hello, now);
  if (const auto* world = std::get_if<WorldState>(&message)) return on(*world, now);
  if (const auto* stop = std::get_if<Stop>(&message)) return end(stop->failed, stop->reason, now);
  if (const auto* status = std::get_if<AgentStatus>(&message)) {
    const auto at = members_.find({status->header.sender, status->header.incarnation});
    if (at == members_.end()) return;
    // Liveness advances only on what is new: a replay keeps nobody alive.
    if (at->second.status && at->second.status->header.sequence >= status->header.sequence) return;
    at->second.status = *status;
    at->second.heard = now;
  }
}

RosterEntry* Coordinator::active_entry(AgentId id) {
  const auto at = std::find_if(roster_.begin(), roster_.end(), [id](const RosterEntry& entry) {
    return entry.author.agent == id && entry.active_until < 0;
  });
  return at == roster_.end() ? nullptr : &*at;
}

std::optional<AgentId> Coordinator::free_id(Instant now) {
  for (AgentId id = 0; id < static_cast<AgentId>(mission_.starts_m.size()); ++id) {
    const RosterEntry* holder = active_entry(id);
    if (holder == nullptr || !alive(*holder, now)) return id;
  }
  return std::nullopt;
}

void Coordinator::on(const Hello& hello, Instant now) {
  if (state_ == MissionState::kEnded || state_ == MissionState::kFailed) return;
  const Incarnation nonce = hello.header.incarnation;
  if (nonce == 0) return;  // the mark of nobody
  const bool known = std::any_of(roster_.begin(), roster_.end(), [nonce](const RosterEntry& entry) {
    return entry.author.incarnation == nonce;
  });
  if (known) {
    // It has not heard: say it again soon, but let nobody's hellos flood the bus.
    next_mission_ = std::min(next_mission_, last_mission_ + kMissionGap);
    return;
  }
  std::optional<AgentId> id = hello.requested_id;
  if (*id == kUnassigned) id = free_id(now);
  if (!id || *id >= static_cast<AgentId>(mission_.starts_m.size())) return;  // the team is full
  const RosterEntry* holder = active_entry(*id);
  if (holder != nullptr && alive(*holder, now)) return;  // the younger has to give way
  admit({*id, nonce}, now);
}

void Coordinator::admit(const Author& author, Instant now) {
  const auto lives = std::count_if(roster_.begin(), roster_.end(), [&](const RosterEntry& entry) {
    return entry.author.agent == author.agent;
  });
  if (roster_.size() >= kMaxRosterEntries || lives >= kMaxIncarnationsPerAgent) return;
  if (RosterEntry* former = active_entry(author.agent)) former->active_until = tick_;
  const Tick from = state_ == MissionState::kRunning ? tick_ : 0;
  roster_.push_back({author, from, -1});
  std::sort(roster_.begin(), roster_.end(),
            [](const RosterEntry& a, const RosterEntry& b) { return a.author < b.author; });
  members_[author].heard = now;
  change();
}

void Coordinator::on(const WorldState& world, Instant now) {
  world_heard_ = true;
  if (world.header.tick < tick_) return;
  if (world.header.tick > tick_) tick_since_ = now;
  tick_ = world.header.tick;
  missed_deadlines_ = std::max(missed_deadlines_, world.missed_deadlines);
  for (int i = 0; i < world.vehicle_count; ++i) {
    const Vehicle& vehicle = world.vehicles[static_cast<std::size_t>(i)];
    answered_[vehicle.id] = vehicle.answered_tick;
  }
  if (tick_ >= mission_.timing.tick_count) end(false, "mission complete", now);
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
  if (now - *started_ < seconds(mission_.timing.admission_timeout_s)) return;
  std::string missing;
  for (AgentId id = 0; id < static_cast<AgentId>(mission_.starts_m.size()); ++id) {
    const RosterEntry* entry = active_entry(id);
    if (entry != nullptr && alive(*entry, now)) continue;
    missing += (missing.empty() ? "" : ", ") + std::to_string(id);
  }
  end(true, "only " + std::to_string(alive_count(now)) + " of the quorum of " +
                std::to_string(mission_.quorum) + " agents were admitted; missing: " + missing, now);
}

void Coordinator::check_tick(Instant now) {
  if (now - tick_since_ < seconds(mission_.timing.lockstep_timeout_s)) return;
  RosterEntry* late = culprit(now);
  std::ostringstream since_text;
  since_text << " for " << mission_.timing.lockstep_timeout_s << " s";
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
  if (mission_.timing.on_timeout == OnTimeout::kEndMission) return end(true, who, now);
  late->active_until = tick_;
  tick_since_ = now;
  change();
}

void Coordinator::advance(Instant now, Outbox& out) {
  if (!started_) started_ = now;
  if (state_ == MissionState::kWaiting) check_admission(now);
  if (state_ == MissionState::kRunning && mission_.timing.pace == Pace::kLockstep) check_tick(now);
  if (state_ == MissionState::kWaiting && alive_count(now) >= mission_.quorum) {
    state_ = MissionState::kRunning;
    tick_since_ = now;
    change();
  }
  if (now >= next_mission_) {
    publish_mission(out);
    last_mission_ = now;
    next_mission_ = now + (ended_ ? kMissionGap : kMissionPeriod);
  }
  if (now >= next_team_status_) {
    publish_team_status(now, out);
    next_team_status_ = now + kTeamStatusPeriod;
  }
  finished_ = ended_ && now - *ended_ >= kFarewell;
}

void Coordinator::publish_mission(Outbox& out) {
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
  team.tick_count = mission_.timing.tick_count;
  team.missed_deadlines = missed_deadlines_;
  team.agents_alive = alive_count(now);
  team.agents_expected = static_cast<std::int32_t>(mission_.starts_m.size());
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
  team.header = header(Bus::kSwarm);
  out.push_back({Bus::kSwarm, team});
}

Header Coordinator::header(Bus bus) {
  return {run_, kCoordinator, incarnation_, sequencer_.next(bus), tick_};
}

Instant Coordinator::next_wakeup() const {
  if (!started_) return Instant{};
  return std::min(next_mission_, next_team_status_);
}

}  // namespace ergocast
