// SPDX-License-Identifier: BSD-3-Clause
// Checks what processes send and do: messages, refusals, ends.
#include "lab/invariants.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/base/noise.h"
#include "core/law/block_layout.h"
#include "core/law/perturbation.h"
#include "core/measure/objects.h"
#include "core/mission/kinds.h"
#include "core/motion/filter_rules.h"
#include "sim/world.h"

namespace ergocast::lab {
namespace {

bool knows_closed_zone(const TableView& agent, Tick tick) {
  return agent.amendments != nullptr &&
         std::ranges::any_of(agent.amendments->zones, [tick](const Zone& zone) {
           return zone.closed <= tick && tick <= zone.end();
         });
}

}  // namespace

std::string to_string(const Violation& v) {
  char t_text[32];
  std::snprintf(t_text, sizeof t_text, "%.4f", v.t_s);
  return std::string(name_of(v.invariant)) + ": " + v.who + " at t = " + t_text +
         " s: " + v.numbers;
}

double recovery_bound_s(const Mission& mission, const Faults& faults) {
  // A restarted coordinator asks (0.25 s), an agent answers (0.05 s, or 0.5 s after its last
  // answer), and the coordinator waits for other answers (0.2 s).
  constexpr double kTakeover_s = 1;
  // It takes all members for running. Then a predecessor must be silent for 3 s, and its successor
  // sends HELLO (0.25 s) and receives MISSION (0.1 s). A restarted world needs as long: it waits
  // 1.5 s and 0.55 s for the mission and 2 s for commands.
  constexpr double kAdmission_s = 4.05;
  // In real time an agent that was forgotten, perhaps a moment ago, is remembered with as much
  // notice.
  const double notices_s = mission.forget_silent_after_s > 0 ? 4 : 0;
  const Timing& timing = mission.timing;
  const double period_s =
      static_cast<double>(longest_period_ticks(timing)) * timing.dt_s / timing.realtime_factor;
  const std::size_t entries = 2 * mission.starts_m.size();  // every agent was restarted once
  return (kTakeover_s + kAdmission_s + hop_s(entries) + notices_s + 2 * period_s) /
         (1 - faults.clock_rate_error);
}

Invariants::Invariants(const Mission& mission)
    : mission_(mission),
      weights_(sobolev_weights(mission.basis, mission.domain)),
      block_count_(block_count_of(mission)),
      wire_modes_(modes_on_wire(mission)),
      objects_(mission) {
  note_ends();
}

/// Notes from when on agents have to be at home.
void Invariants::note_ends() {
  const Amendments& list = truth_.amendments();
  const Tick ticks = ticks_of(mission_, &list);
  for (AgentId id = 0; id < std::ssize(mission_.starts_m); ++id) {
    const Tick until = covers_until(mission_, id, &list);
    if (until <= ticks) home_from_[id] = keeps_distance(mission_) ? ticks : until;
  }
}

void Invariants::violate(double t_s, Invariant invariant, const std::string& who,
                         std::string numbers) {
  if (!violation_) violation_ = {invariant, who, t_s, std::move(numbers)};
}

void Invariants::started(const Author& author) {
  authors_.push_back(author);
  std::sort(authors_.begin(), authors_.end());
  ++incarnation_count_[author.agent];
}

// ---- safety: what is sent ----

void Invariants::sent(double t_s, const Outgoing& outgoing, const TableView* speaker) {
  if (const auto* world = std::get_if<WorldState>(&outgoing.message)) return check(t_s, *world);
  if (const auto* part = std::get_if<MissionPart>(&outgoing.message)) {
    if (!truth_.receive(*part)) return;
    const Amendments& list = truth_.amendments();
    shifted_ = shifted_ || !list.targets.empty() || !list.ends.empty();
    for (const Zone& zone : list.zones) note_zone(zone);
    note_ends();
    note_end_of(list);
    return check_closed_numbers(t_s);
  }
  if (const auto* command = std::get_if<Command>(&outgoing.message)) {
    // A repeated command was checked before.
    const bool answers = speaker != nullptr && command->header.tick == speaker->answered;
    if (!answers) return;
    check_ended(t_s, *command, *speaker);
    return check(t_s, *command, *speaker);
  }
  if (const auto* block = std::get_if<Contribution>(&outgoing.message)) {
    return check(t_s, *block, outgoing.relayer, speaker);
  }
  const auto* effort = std::get_if<Effort>(&outgoing.message);
  if (effort != nullptr && outgoing.relayer == kUnassigned) note_looks(*effort);
  const auto* digest = std::get_if<Digest>(&outgoing.message);
  if (digest != nullptr && speaker != nullptr) check(t_s, *digest, *speaker);
}

void Invariants::check(double t_s, const WorldState& world) {
  if (mission_.radio_range_m > 0 && world.header.tick >= last_tick_) note_positions(t_s, world);
  if (world.header.tick >= last_tick_) check_zones(t_s, world);
  last_tick_ = std::max(last_tick_, world.header.tick);
  if (keeps_distance(mission_)) check_distances(t_s, world);
  check_paused(t_s, world);
  check_ended(t_s, world);
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    places_m_[vehicle.id] = vehicle.position_m;
    note_charge(vehicle, world.header.tick);
    if (!mission_.walls.empty()) check_wall(t_s, vehicle);
    if (mission_.domain.contains(vehicle.position_m)) continue;
    violate(t_s, Invariant::kPositionsInTheDomain, "vehicle " + std::to_string(vehicle.id),
            text("x = (", vehicle.position_m.x(), ", ", vehicle.position_m.y(), ") m"));
  }
  check_home(t_s, world);
  check_batteries(t_s, world);
  check_detections(t_s, world);
}

/// Uses the true places, once all places of a tick are known. Starts may be exactly at the least
/// distance.
void Invariants::check_distances(double t_s, const WorldState& world) {
  state_.take(world);
  if (!state_.complete(world.header.tick)) return;
  const auto bodies = state_.neighbours(mission_);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double apart_m = (bodies[i].position_m - bodies[j].position_m).norm();
      if (apart_m >= mission_.separation.distance_m * (1 - 1e-9)) continue;
      violate(t_s, Invariant::kDistanceKept,
              "vehicles " + std::to_string(bodies[j].id) + " and " + std::to_string(bodies[i].id),
              text(apart_m, " m apart at tick ", world.header.tick));
    }
  }
}

void Invariants::note_positions(double t_s, const WorldState& world) {
  for (const Vehicle& vehicle : world.vehicles_in_part()) {
    positions_m_[vehicle.id] = vehicle.position_m;
  }
  for (auto a = positions_m_.begin(); a != positions_m_.end(); ++a) {
    for (auto b = std::next(a); b != positions_m_.end(); ++b) {
      if ((a->second - b->second).norm() <= mission_.radio_range_m) continue;
      last_apart_t_s_[{a->first, b->first}] = t_s;
    }
  }
}

void Invariants::check(double t_s, const Command& command, const TableView& speaker) {
  if (command.header.tick < 0) return;
  if (speaker.held) return check_paused(t_s, command);
  // A repeated command may be older than the law that its sender knows by now.
  const auto [newest, first] = commanded_.try_emplace(speaker.self, command.header.tick);
  const bool has_laws = speaker.amendments != nullptr && !speaker.amendments->laws.empty();
  if (has_laws && !first && command.header.tick <= newest->second) return;
  newest->second = std::max(newest->second, command.header.tick);
  const int kind = planned_kind(mission_, command.header.sender);
  ControlLaw law = law_of(mission_, kind);
  // On the way home and out of a zone the plan's speed holds.
  const double plans_mps = law.u_max_mps;
  if (const auto* numbers = law_numbers_at(speaker.amendments, kind, command.header.tick)) {
    law.u_max_mps = numbers->u_max_mps;
    law.noise_intensity = numbers->noise_intensity;
    law.noise_ceiling = numbers->noise_ceiling;
  }
  const Eigen::Vector3d contraction_mps =
      law.contraction_gain_per_s * (command.position_m - law.contraction_center_m);
  const double root_dt = std::sqrt(mission_.timing.dt_s);
  const auto sender = static_cast<std::uint32_t>(command.header.sender);
  const Eigen::Vector3d xi = normal_in(mission_.domain, mission_.seed, Purpose::kPerturbation,
                                       sender, static_cast<std::uint64_t>(speaker.counted));
  const Eigen::Vector3d noise_mps = law.noise_intensity / root_dt * xi;
  // An adaptive law may add this much, in a direction that only the agent knows.
  double push_mps = 0;
  if (law.perturbation == Perturbation::kAdaptive) {
    const double dt_s = mission_.timing.dt_s;
    push_mps = greatest_push_mps(law, dt_s) *
               normal_in(mission_.domain, mission_.seed, Purpose::kPush,
                         law.paired_pushes ? sender & ~1U : sender,
                         static_cast<std::uint64_t>(speaker.counted / push_ticks(law, dt_s)))
                   .norm();
  }
  const Eigen::Vector3d v_mps = command.velocity_mps;
  const double limit_mps = motion_of(mission_, command.header.sender).speed_limit_mps;
  const bool filtered = filters_commands(mission_, command.header.sender);
  if (filtered && v_mps.norm() <= limit_mps * (1 + 1e-12)) return;
  const double u_mps = (v_mps + contraction_mps - noise_mps).norm();
  // Each of the three was rounded when v was put together.
  const double margin_mps =
      8 * 0x1p-53 * (v_mps.norm() + contraction_mps.norm() + noise_mps.norm());
  if (u_mps <= (law.u_max_mps + push_mps) * (1 + 1e-12) + margin_mps) return;
  const RosterEntry* const own =
      speaker.roster != nullptr ? entry_of(*speaker.roster, speaker.self) : nullptr;
  const bool may_go_home =
      home_from_.contains(command.header.sender) || (own != nullptr && is_recalled(*own, speaker));
  if (may_go_home && v_mps.norm() <= plans_mps * (1 + 1e-12)) return;
  // Beside a zone the filter turns a command. It may then have its length, but no more.
  const double longest_mps = plans_mps + push_mps + contraction_mps.norm() + noise_mps.norm();
  if (knows_closed_zone(speaker, command.header.tick) && v_mps.norm() <= longest_mps * (1 + 1e-6))
    return;
  violate(t_s, Invariant::kInputsBounded, "agent " + std::to_string(command.header.sender),
          text("|u| = ", u_mps, " m/s > ", law.u_max_mps, " m/s at tick ", command.header.tick));
}

void Invariants::check(double t_s, const Contribution& block, AgentId relayer,
                       const TableView* speaker) {
  if (mission_.law.memory_half_life_s > 0) check_memory(t_s, block);
  const double covered_s = mission_.law.memory_half_life_s > 0
                               ? block.elapsed_s
                               : static_cast<double>(block.steps) * mission_.timing.dt_s;
  // Samples are shifted once the team has had another target.
  const double range = shifted_ ? kShiftedRange : 1;
  const double most_s = range * covered_s * (1 + 1e-9 + rounding(block.steps));
  double largest_s = 0;
  for (const double sum_s : block.sums) largest_s = std::max(largest_s, std::abs(sum_s));
  const bool zeroth_is_off =
      block.block == 0 && std::abs(block.sums[0] - covered_s) > covered_s * rounding(block.steps);
  if (!(largest_s <= most_s) || zeroth_is_off) {
    violate(t_s, Invariant::kSumsBounded, name_of(block.author()),
            text("largest |S| = ", largest_s, " s, S_00 = ", block.sums[0], " s, time covered ",
                 covered_s, " s, block ", block.block));
  }
  if (relayer == kUnassigned || speaker == nullptr) return;
  ++relayed_;
  if (--relays_allowed_[speaker->self] >= 0) return;
  violate(
      t_s, Invariant::kRelaysAnswerDigests, name_of(speaker->self),
      text("has relayed more blocks than the digests it received could ask for; the last one of ",
           name_of(block.author())));
}

/// Between two blocks of an author that has sampled each tick from the one to the other, the time
/// is halved at the ticks of the half-life, and grows by dt at each tick.
void Invariants::check_memory(double t_s, const Contribution& block) {
  const double dt_s = mission_.timing.dt_s;
  Sent& before = sent_[{block.author(), block.block}];
  const Sent now{block.steps, block.header.tick, block.elapsed_s};
  if (now.steps <= before.steps) return;
  const bool whole = before.steps > 0 && now.steps - before.steps == now.tick - before.tick;
  double expected_s = before.elapsed_s;
  for (Tick tick = before.tick + 1; whole && tick <= now.tick; ++tick) {
    if (halvings_at(mission_, tick) != halvings_at(mission_, tick - 1)) expected_s /= 2;
    expected_s += dt_s;
  }
  const double error_s = whole ? std::abs(now.elapsed_s - expected_s) : 0;
  const bool possible = now.elapsed_s <= static_cast<double>(now.steps) * dt_s * (1 + 1e-9);
  if (error_s > 1e-9 * expected_s || !possible) {
    violate(t_s, Invariant::kSumsBounded, name_of(block.author()),
            text("remembers ", now.elapsed_s, " s of ", now.steps, " steps at tick ", now.tick,
                 ", expected ", expected_s));
  }
  before = now;
}

void Invariants::check(double t_s, const Digest& digest, const TableView& speaker) {
  for (int i = 0; i < digest.entry_count; ++i) {
    const DigestEntry& entry = digest.entries[static_cast<std::size_t>(i)];
    const std::int64_t held = steps_of(*speaker.table, entry.author);
    if (entry.steps == held) continue;
    violate(t_s, Invariant::kDigestsSayWhatIsHeld, name_of(speaker.self),
            text("says ", entry.steps, " steps of ", name_of(entry.author), ", holds ", held));
  }
}

void Invariants::digest_received(const Author& listener, const Digest& digest) {
  relays_allowed_[listener] += static_cast<std::int64_t>(digest.entry_count) * block_count_;
}

void Invariants::decoded(double t_s, const Decoded& result, bool damaged) {
  if (!damaged && !result) {
    violate(t_s, Invariant::kWholeMessagesAccepted, "the codec", to_string(result.error()));
  }
  if (damaged && result) {
    violate(t_s, Invariant::kDamagedMessagesRefused, "the codec",
            text("a message of type ", result->index()));
  }
}

void Invariants::refused(double t_s, const Author& who, const RefusalCounts& counts) {
  for (std::size_t kind = 0; kind < counts.size(); ++kind) {
    if (counts[kind] == 0) continue;
    violate(t_s, Invariant::kHonestMessagesAccepted, name_of(who),
            text(counts[kind], " refused: ", to_string(static_cast<Refusal>(kind))));
  }
}

void Invariants::finished(double t_s, const Author& who, const std::string& reason,
                          bool mission_over) {
  if (mission_over) return;
  violate(t_s, Invariant::kNoEarlyEnd, name_of(who), reason);
}

void Invariants::wakeup(double t_s, const std::string& who, bool in_the_past) {
  if (in_the_past) violate(t_s, Invariant::kNoWakeupInThePast, who, "next_wakeup() <= now");
}

void Invariants::gave_up_logger(double t_s, std::optional<Tick> acknowledged, Tick tick) {
  if (!acknowledged || tick - *acknowledged > kRecordWindowTicks) return;
  violate(t_s, Invariant::kHeardLoggerIsKept, "the world",
          text("gives up at tick ", tick, " a logger whose message of tick ", *acknowledged,
               " has reached it"));
}

// ---- liveness ----

void Invariants::coordinated(double t_s, const Coordinator& coordinator, Instant now,
                             const std::vector<TableView>& living) {
  for (const TableView& holder : living) {
    const RosterEntry* entry = entry_of(coordinator.roster(), holder.self);
    const char* taken_for =
        entry == nullptr ? "nobody" : to_string(coordinator.member_state(*entry, now));
    if (entry != nullptr && coordinator.member_state(*entry, now) == MemberState::kAlive) continue;
    violate(t_s, Invariant::kLiveAgentsAreKnown, "the coordinator",
            text("takes ", name_of(holder.self), " for ", taken_for));
  }
}

void Invariants::check_quiet(double t_s) {
  if (recovered_ && relayed_ > 0 && mission_.radio_range_m <= 0) {
    violate(t_s, Invariant::kRelaysStop, "the team", text(relayed_, " blocks relayed"));
  }
  recovered_ = true;
  relayed_ = 0;
}

void Invariants::ended(double t_s, const std::string& still_running, const std::string& failure,
                       const RunFacts& facts, Tick excused) {
  if (!still_running.empty()) {
    violate(t_s, Invariant::kEverybodyEnds, still_running, text("at tick ", last_tick_));
  }
  if (!failure.empty()) violate(t_s, Invariant::kMissionDoesNotFail, "the coordinator", failure);
  const Tick ticks = ticks_of(mission_, &truth_.amendments());
  if (counted_ticks(truth_.holds(), last_tick_) < ticks) {
    violate(t_s, Invariant::kLastTickReached, "the world",
            text("tick ", last_tick_, " of ", ticks));
  }
  const Tick counted = facts.ticks - facts.held_ticks;
  if (counted + excused < ticks) {
    violate(t_s, Invariant::kRecordIsWhole, "the logger",
            text(counted, " of ", ticks, " ticks, and only ", excused, " may be missing"));
  }
  check_finds(t_s, facts.finds, excused);
  const bool recalled =
      std::ranges::any_of(truth_.roster(), [](const auto& entry) { return entry.recalled(); });
  // Fewer agents may miss it, and it was for the plan's target.
  const double goal = recalled || shifted_ ? 0 : mission_.goal_ergodic_metric;
  if (goal > 0 && !(facts.ergodic_metric_last <= goal)) {
    violate(t_s, Invariant::kGoalReached, "the team",
            text("phi^2 = ", facts.ergodic_metric_last, " > ", goal,
                 mission_.basis.free_domain ? " in modes of the free domain" : ""));
  }
}

}  // namespace ergocast::lab
