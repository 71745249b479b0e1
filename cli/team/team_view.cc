// SPDX-License-Identifier: BSD-3-Clause
// Stores the newest message of every kind from each process, and derives the state of each row from
// their ages.
#include "cli/team/team_view.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "core/mission/kinds.h"
#include "core/mission/station.h"
#include "core/motion/charge.h"
#include "core/motion/home.h"
#include "core/motion/vehicle.h"
#include "core/search/search_cells.h"
#include "team/median_metric.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

constexpr PacingClock::duration kOverdue = 2 * kAgentStatusPeriod;
/// In lockstep every agent waits now and then; a longer wait is reported.
constexpr PacingClock::duration kStandstill = 750ms;
/// An agent is late if its event loop was blocked, or it is behind the world, by this time.
constexpr double kLate_s = 0.5;
/// In a replay, the status of an agent comes each mission second.
constexpr double kSilentInReplay_s = 6;

double to_s(PacingClock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

std::optional<double> metric_of_members(const std::vector<AgentRow>& rows) {
  std::vector<const AgentStatus*> members;
  for (const AgentRow& row : rows) {
    if (row.status && row.condition != Condition::kGone) members.push_back(&*row.status);
  }
  return median_metric(members);
}

}  // namespace

const char* to_string(Condition condition) {
  constexpr const char* kWords[] = {"silent", "waiting",  "late", "not heard",
                                    "ok",     "finished", "gone"};
  return kWords[static_cast<int>(condition)];
}

TeamView::TeamView(RunId run, Instant since, bool authenticated, bool replay)
    : me_(kRole, {run, kUnassigned, 0}),
      authenticated_(authenticated),
      replay_(replay),
      since_(since) {}

void TeamView::receive(const Message& message, Bus bus, AgentId transmitter, Instant now) {
  const auto arrival = me_.accept(message, bus, transmitter, now);
  if (!arrival) return;
  tick_ = std::max(tick_, arrival->from.tick);
  // An agent may repeat MISSION long after the coordinator exited.
  const Header& from = arrival->from;
  const bool first_hand = arrival->fresh && !std::holds_alternative<MissionPart>(message);
  if (first_hand && from.sender < kUnassigned) processes_[from.sender] = from;
  std::visit([&](const auto& m) { on(m, *arrival); }, message);
}

void TeamView::on(const TeamStatus& team, const Arrival&) {
  coordinator_host_ = team.host;
  tick_count_ = team.tick_count;
  team_state_ = team.state;
  team_paused_ = team.paused;
}

void TeamView::on(const WorldState& world, const Arrival& arrival) {
  world_tick_ = std::max(world_tick_, arrival.from.tick);
  missed_deadlines_ = std::max(missed_deadlines_, world.missed_deadlines);
  skipped_ticks_ = std::max(skipped_ticks_, world.skipped_ticks);
  clamped_commands_ = std::max(clamped_commands_, world.clamped_commands);
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    const auto [at, is_new] = vehicles_.try_emplace(vehicle.id);
    if (is_new || arrival.from.tick >= at->second.first) at->second = {arrival.from.tick, vehicle};
  }
}

void TeamView::on(const RecordAck& ack, const Arrival& arrival) {
  if (!arrival.fresh) return;
  detection_probability_ = ack.detection_probability;
  contacts_.assign(ack.all_contacts().begin(), ack.all_contacts().end());
  more_contacts_ = ack.contact_count >= ack.contact_room();
  const auto finds = ack.all_finds();
  if (finds.size() > finds_.size()) finds_.assign(finds.begin(), finds.end());
  wrong_confirmations_ = std::max(wrong_confirmations_, ack.wrong_confirmations);
}

Instant TeamView::last_sign(const Author& author) const {
  return me_.liveness().last_sign(author).value_or(since_);
}

void TeamView::on(const AgentStatus& status, const Arrival& arrival) {
  const Author author{status.header.sender, status.header.incarnation};
  if (author.agent < 0 || !arrival.fresh) return;
  const auto [at, is_new] = agents_.try_emplace(author);
  Seen& seen = at->second;
  if (is_new || status.header.tick != seen.status.header.tick) seen.tick_since = arrival.now;
  seen.status = status;
  const auto& mission = follower().mission();
  if (mission && mission->timing.pace == Pace::kRealtime) {
    const Timing& timing = mission->timing;
    seen.behind_s = static_cast<double>(world_tick_ - status.header.tick - 1) * timing.dt_s /
                    timing.realtime_factor;
  }
}

bool TeamView::silent(const Author& author, const Seen& seen, Instant now) const {
  if (!replay_) return me_.silent(author, now);
  const auto& mission = follower().mission();
  const auto behind = static_cast<double>(world_tick_ - seen.status.header.tick);
  return mission && !over() && behind * mission->timing.dt_s > kSilentInReplay_s;
}

Condition TeamView::condition_of(const Author& author, const Seen& seen, Instant now) const {
  const AgentStatus& status = seen.status;
  if (status.phase == AgentPhase::kFinished) return Condition::kFinished;
  if (silent(author, seen, now)) return Condition::kSilent;
  if (replay_) return Condition::kOk;
  const bool stands_still = now - seen.tick_since >= kStandstill;
  if (status.waiting_for == kWorld || (status.waiting_for != kUnassigned && stands_still)) {
    return Condition::kWaiting;
  }
  const bool late = now - last_sign(author) >= kOverdue || status.loop_lag_s >= kLate_s ||
                    (answers_ticks(status.phase) && seen.behind_s >= kLate_s);
  return late ? Condition::kLate : Condition::kOk;
}

AgentRow TeamView::row_of(const Author& author, bool member, Instant now) const {
  AgentRow row{author, Condition::kUnheard, to_s(now - since_), 0, {}, 0};
  if (!replay_ && now - since_ >= silence_of(author.agent)) row.condition = Condition::kSilent;
  if (const auto seen = agents_.find(author); seen != agents_.end()) {
    row.status = seen->second.status;
    row.tick = me_.counted(row.status->header.tick);
    row.silent_s = to_s(now - last_sign(author));
    row.condition = condition_of(author, seen->second, now);
    const double dt_s = follower().mission() ? follower().mission()->timing.dt_s : 0;
    row.blocked_s = static_cast<double>(row.status->blocked_now_ticks) * dt_s;
  }
  if (member) add_vehicle(row);
  if (!member && row.condition != Condition::kFinished) row.condition = Condition::kGone;
  const auto& roster = follower().roster();
  const RosterEntry* const own = follower().entry_of(author.incarnation);
  if (own != nullptr && follower().mission())
    row.kind = name_of_kind(*follower().mission(), own->kind);
  row.restarts =
      static_cast<int>(std::count_if(roster.begin(), roster.end(), [&](const auto& entry) {
        return entry.author.agent == author.agent && entry.author != author;
      }));
  return row;
}

/// An agent that goes home for its battery stays there until the battery is full.
bool TeamView::charges(const AgentRow& row, const Mission& mission, const Vehicle& vehicle) {
  const AgentId id = row.author.agent;
  const bool returns = row.status && row.status->phase == AgentPhase::kReturning;
  if (!returns || battery_of(mission, id) == nullptr) return false;
  if (vehicle.charge_ppm == kNoCharge || vehicle.charge_ppm >= kFull_ppm) return false;
  return length_of(*station_of(mission, id) - vehicle.position_m) <= home_m(mission, id);
}

void TeamView::add_vehicle(AgentRow& row) const {
  const auto found = vehicles_.find(row.author.agent);
  const auto& mission = follower().mission();
  if (found == vehicles_.end() || !mission) return;
  const Vehicle& vehicle = found->second.second;
  const int axes = mission->domain.planar() ? 2 : 3;
  row.position_tick = found->second.first;
  row.position_m.assign(vehicle.position_m.data(), vehicle.position_m.data() + axes);
  row.velocity_mps.assign(vehicle.velocity_mps.data(), vehicle.velocity_mps.data() + axes);
  row.charge_ppm = vehicle.charge_ppm;
  row.charges = charges(row, *mission, vehicle);
  row.moves = !stands(motion_of(*mission, row.author.agent), vehicle.velocity_mps);
}

/// For each number: the newest incarnation, and whether it is a member.
std::map<AgentId, std::pair<Author, bool>> TeamView::newest_incarnations() const {
  std::map<AgentId, std::pair<Author, bool>> incarnations;
  if (follower().revision() < 0) {
    std::map<AgentId, Instant> heard;
    for (const auto& [author, seen] : agents_) {
      const Instant sign = last_sign(author);
      if (const auto [at, is_new] = heard.try_emplace(author.agent, sign);
          is_new || sign > at->second) {
        at->second = sign;
        incarnations[author.agent] = {author, true};
      }
    }
    return incarnations;
  }
  std::map<AgentId, Tick> left;
  for (const RosterEntry& entry : follower().roster()) {
    const bool member = entry.active_until < 0;
    const auto [at, is_new] = left.try_emplace(entry.author.agent, entry.active_until);
    if (!is_new && !member &&
        (incarnations[entry.author.agent].second || entry.active_until <= at->second)) {
      continue;
    }
    at->second = entry.active_until;
    incarnations[entry.author.agent] = {entry.author, member};
  }
  return incarnations;
}

void TeamView::add_agents(TeamPicture& picture, Instant now) const {
  int members = 0;
  for (const auto& [id, newest] : newest_incarnations()) {
    const AgentRow& row = picture.agents.emplace_back(row_of(newest.first, newest.second, now));
    members += newest.second ? 1 : 0;
    picture.agents_alive +=
        newest.second && row.status && row.condition != Condition::kSilent ? 1 : 0;
  }
  const auto& mission = follower().mission();
  const int planned = mission ? static_cast<int>(mission->starts_m.size()) : 0;
  picture.agents_expected = std::max(members, planned);
  picture.free_domain = mission && mission->basis.free_domain;
  std::stable_sort(picture.agents.begin(), picture.agents.end(),
                   [](const AgentRow& a, const AgentRow& b) { return a.condition < b.condition; });
  picture.ergodic_metric = metric_of_members(picture.agents);
  picture.trouble |=
      std::any_of(picture.agents.begin(), picture.agents.end(),
                  [](const AgentRow& row) { return row.condition < Condition::kUnheard; });
}

/// The coordinator receives nothing from a forgotten member.
void TeamView::add_forgotten(TeamPicture& picture) const {
  for (const RosterEntry& entry : follower().roster()) {
    if (!entry.forgotten) continue;
    picture.trouble |= entry.active_until < 0;
    if (picture.forgotten.empty() || picture.forgotten.back() != entry.author.agent) {
      picture.forgotten.push_back(entry.author.agent);
    }
  }
}

void TeamView::add_contacts(TeamPicture& picture) const {
  const auto& mission = follower().mission();
  if (!mission || !mission->sensor.has_false_alarms()) return;
  const SearchCells search(*mission);
  picture.more_contacts = more_contacts_;
  for (Contact contact : contacts_) {
    if (static_cast<std::size_t>(contact.cell) >= search.cells.total()) continue;
    contact.x_m = search.middle_m(contact.cell);
    contact.t_s = static_cast<double>(contact.newest) * mission->timing.dt_s;
    picture.contacts.push_back(contact);
  }
}

/// Whether a process of that kind must send at this stage of the mission.
bool TeamView::should_report(AgentId sender) const {
  if (over() || !follower().mission()) return sender == kCoordinator && !over();
  if (sender == kWorld) return follower().state() == MissionState::kRunning;
  // A team that does not wait for a logger may run without one.
  const bool heard = processes_.contains(sender);
  return sender == kCoordinator || heard || follower().mission()->wait_for_logger;
}

void TeamView::add_process(TeamPicture& picture, AgentId sender, Instant now) const {
  ProcessRow row;
  row.name = sender == kCoordinator ? "coordinator" : sender == kWorld ? "world" : "logger";
  row.silent_s = to_s(now - since_);
  if (const auto heard = processes_.find(sender); heard != processes_.end()) {
    row.heard = true;
    row.silent_s = to_s(now - me_.liveness().last_sign_of_kind(sender).value_or(since_));
    row.incarnation = heard->second.incarnation;
    row.tick = me_.counted(heard->second.tick);
  }
  if (sender == kCoordinator) row.host = coordinator_host_;
  row.trouble = !replay_ && should_report(sender) && me_.silent(sender, now, since_);
  picture.trouble |= row.trouble;
  picture.processes.push_back(std::move(row));
}

TeamPicture TeamView::picture(Instant now) const {
  TeamPicture picture;
  picture.run = me_.run();
  picture.replay = replay_;
  picture.authenticated = authenticated_;
  picture.tick_count = tick_count_;
  if (const auto& mission = follower().mission()) {
    picture.scenario = mission->name;
    picture.tick_count = tick_count_of(mission->timing, follower().amendments().ends);
    picture.dt_s = mission->timing.dt_s;
  }
  const Tick end = tick_after(follower().holds(), picture.tick_count);
  picture.tick = picture.tick_count > 0 ? std::min(tick_, end) : tick_;
  picture.holds.assign(follower().holds().begin(), follower().holds().end());
  if (const auto* change = target_at(follower().amendments().targets, picture.tick))
    picture.target = {change->number, AmendmentKind::kTarget, change->from, target_hash(*change)};
  const auto& ends = follower().amendments().ends;
  if (!ends.empty())
    picture.end = {ends.back().number, AmendmentKind::kEnd, ends.back().from,
                   static_cast<std::uint64_t>(ends.back().tick_count)};
  for (const Zone& zone : follower().amendments().zones)
    if (zone.closed_at(picture.tick)) picture.zones.push_back(zone);
  const LawChange* const law = law_at(follower().amendments().laws, picture.tick);
  if (law != nullptr) {
    picture.law = *law;
    picture.law_text = law_text(*law, *follower().mission());
  }
  picture.counted = counted_ticks(follower().holds(), picture.tick);
  picture.paused =
      !over() && (follower().mission() ? is_held(follower().holds(), picture.tick) : team_paused_);
  picture.state = follower().revision() < 0 ? team_state_ : std::optional(follower().state());
  picture.reason = follower().plan_problem().value_or(follower().reason());
  picture.detection_probability = detection_probability_;
  if (const auto& mission = follower().mission()) {
    picture.objects = mission->objects.total();
    picture.finds = finds_;
    if (mission->sensor.has_false_alarms()) picture.wrong_confirmations = wrong_confirmations_;
    for (Find& find : picture.finds)
      find.t_s = static_cast<double>(me_.counted(find.tick)) * mission->timing.dt_s;
  }
  picture.missed_deadlines = missed_deadlines_;
  picture.skipped_ticks = skipped_ticks_;
  picture.clamped_commands = clamped_commands_;
  picture.trouble = picture.state == MissionState::kFailed || follower().plan_problem().has_value();
  picture.over = over();
  add_agents(picture, now);
  add_forgotten(picture);
  add_contacts(picture);
  for (const AgentId sender : {kCoordinator, kWorld, kLogger}) add_process(picture, sender, now);
  const bool under_way = picture.state == MissionState::kRunning && !over() && !replay_;
  picture.trouble |= under_way && picture.agents_alive < picture.agents_expected;
  return picture;
}

bool TeamView::complete() const {
  if (!follower().mission()) return false;
  for (const AgentId sender : {kCoordinator, kWorld, kLogger}) {
    if (should_report(sender) && !processes_.contains(sender)) return false;
  }
  const auto incarnations = newest_incarnations();
  return std::all_of(incarnations.begin(), incarnations.end(), [this](const auto& one) {
    const auto& [author, member] = one.second;
    return !member || agents_.contains(author);
  });
}

bool TeamView::over() const {
  if (follower().over()) return true;
  bool anybody_finished = false;
  for (const auto& [id, newest] : newest_incarnations()) {
    const auto& [author, member] = newest;
    const auto seen = agents_.find(author);
    const bool finished =
        seen != agents_.end() && seen->second.status.phase == AgentPhase::kFinished;
    // An incarnation that was removed from the roster, for example after a crash, does not report
    // its end.
    if (member && !finished) return false;
    anybody_finished |= finished;
  }
  return anybody_finished;
}

}  // namespace ergocast
