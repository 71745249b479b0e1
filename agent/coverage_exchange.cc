// SPDX-License-Identifier: BSD-3-Clause
// Keeps the own blocks as they were last broadcast: repeats and gains refer to them.
#include "agent/coverage_exchange.h"

#include <algorithm>
#include <chrono>
#include <span>
#include <utility>

#include "core/law/look_ahead.h"
#include "core/mission/half_life.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

constexpr auto kDigestPeriod = 1s;
constexpr double kDigestMissionPeriod_s = 1.0;

/// Writes into `block` what it has gained since the broadcast `before`. A block that is sent again
/// within a tick keeps its gains. Gains travel as averages over their steps at the row's mean time
/// a step, so with a half-life they are scaled to that time.
void note_gains(const Contribution& before, const HalfLife& half_life, Contribution& block) {
  const double kept = HalfLife::factor(half_life.halvings(before.header.tick),
                                       half_life.halvings(block.header.tick));
  if (before.steps == block.steps) {
    block.gains = before.gains;
    block.gained_steps = before.gained_steps;
    if (kept == 1) return;
    for (double& gain : block.gains.edit()) gain *= kept;
    return;
  }
  block.gained_steps = block.steps - before.steps;
  const std::span<double> gains = block.gains.set_all(block.sums.size());
  const double *now = block.sums.data(), *then = before.sums.data();
  double scale = 1;
  if (half_life.any()) {
    const double gained_share = 1 - before.elapsed_s * kept / block.elapsed_s;
    scale =
        static_cast<double>(block.gained_steps) / (static_cast<double>(block.steps) * gained_share);
  }
  for (std::size_t k = 0; k < gains.size(); ++k) gains[k] = (now[k] - kept * then[k]) * scale;
}

}  // namespace

CoverageExchange::CoverageExchange(const Mission& mission, const RosterEntry& self, Tick joined)
    : self_(self.author),
      kind_(self.kind),
      sensors_(mission),
      table_(mission.basis, mission.timing.dt_s, joined),
      anti_entropy_(self.author, mission.seed, mission.timing.dt_s),
      team_coverage_(Coefficients::Zero(mission.basis.mode_count())) {
  table_.set_layout(BlockLayout(mission));
  table_.set_half_life(HalfLife(mission));
  if (!looks_ahead(mission)) table_.forgo_gains();
  table_.add_row(self_);  // before any other incarnation could take its place
  table_.set_quality(self_, sensors_.of(kind_).quality);
  published_.resize(static_cast<std::size_t>(table_.block_count()));
}

const Coefficients& CoverageExchange::team_coverage() const {
  table_.average(team_coverage_);
  return team_coverage_;
}

// ---- the own coverage ----

void CoverageExchange::add_sample(Tick counted, const BasisAt& at, const TargetShift& shift) {
  table_.add_sample(self_, at, sensors_.of(kind_).footprint());
  const TargetShift::Change* const change = shift.of_sample(counted);
  if (change != nullptr) table_.shift_sample(self_, change->by_slot.data());
}

/// An agent that learns late of a pause has counted too many ticks. The tick that it announced is
/// then too late, so it broadcasts at once. So does an agent that rests no more, because its recall
/// was lost with a coordinator.
void CoverageExchange::broadcast(bool all, const AgentStep& step, const EndSchedule& ends,
                                 Participant& me, Outbox& out) {
  const Tick counted = step.counted, end = std::max(counted + 1, ends.tick_count_at(counted));
  all = all || (rests_ && !step.recalled);
  rests_ = step.recalled;
  for (int b = 0; b < table_.block_count(); ++b) {
    auto& [published, tick, next] = published_[static_cast<std::size_t>(b)];
    if (!all && counted >= tick && counted < next) continue;
    Contribution block = table_.block(self_, b);
    if (rests_ && block.steps == 0) continue;  // it has rested since its admission
    // Repeats keep it: forecasts count a block's age from it, and receivers how often the block has
    // been halved. So it is not before the block's last halving, also if ticks are counted again.
    block.header.tick = std::max(counted, block.header.tick);
    if (block.encoding == ContributionEncoding::kFixed16)
      note_gains(published, table_.half_life(), block);
    tick = counted;
    next = rests_ ? end : next_broadcast(me.mission(), ends, self_.agent, counted, b);
    block.next_broadcast_tick = next - counted + block.header.tick;
    me.publish(Bus::kSwarm, block, block.header.tick, out);
    published = std::move(block);
  }
}

/// Newer sums would make a tick depend on losses.
void CoverageExchange::repeat(Participant& me, Outbox& out) const {
  for (const auto& [block, tick, next] : published_) {
    if (block.steps > 0) me.publish(Bus::kSwarm, block, block.header.tick, out);
  }
}

// ---- the coverage of teammates ----

void CoverageExchange::note_received(const Contribution& theirs, AgentId transmitter) {
  if (transmitter != theirs.header.sender) anti_entropy_.on_relayed(theirs, table_);
  ++received_;
}

std::optional<Refusal> CoverageExchange::merge(const Contribution& theirs, int kind,
                                               std::int64_t max_steps, Tick counted) {
  switch (table_.merge(theirs, max_steps)) {
    case Merge::kRefusedRange:
      return Refusal::kRange;
    case Merge::kRefusedShift:
      // Its author may know of a new target first: in real time, or because its team goes on
      // without us and we do not know that yet. It sends the block again.
      return std::nullopt;
    case Merge::kRefusedLimit:
      return Refusal::kLimit;
    case Merge::kRefusedEncoding:
      return Refusal::kEncoding;
    case Merge::kNewer:
      if (!sensors_.uniform()) table_.set_quality(theirs.author(), sensors_.of(kind).quality);
      last_update_[theirs.author()] = counted;
      break;
    case Merge::kStale:
      // A battery that is charged adds no step, and what its agent sends meanwhile is an update.
      if (Tick* const last = last_update_.find(theirs.author()))
        *last = std::max(*last, std::min(counted, theirs.header.tick));
      break;
  }
  return std::nullopt;
}

/// This also runs in a pause, because forgetting goes by the world's ticks, and the agent then
/// reports the c_k that counts.
void CoverageExchange::forget_silent(const AgentStep& step, const Participant& me) {
  table_.remember_all();
  for (const RosterEntry& entry : me.follower().roster()) {
    // Our own coverage always counts: we run, even if the coordinator receives nothing from us.
    if (entry.author == self_) continue;
    if (entry.forgotten_at(step.tick, step.roster_revision)) table_.forget(entry.author);
  }
  if (listed_by_ != me.follower().revision()) note_unlisted(me.follower());
  for (const Author& author : unlisted_) table_.forget(author);
}

/// A coordinator may take over without an admission that its predecessor sent to a few agents. The
/// others refuse that author's row, and all agents have to go by the same rows.
void CoverageExchange::note_unlisted(const MissionFollower& known) {
  listed_by_ = known.revision();
  unlisted_.clear();
  for (const Author& author : last_update_.authors()) {
    if (known.entry_of(author.incarnation) == nullptr) unlisted_.push_back(author);
  }
}

AgentId CoverageExchange::awaited(const AgentStep& step, const RadioRange& radio,
                                  const EndSchedule& ends, const Participant& me) const {
  for (const RosterEntry& entry : me.follower().roster()) {
    if (entry.author == self_ || !entry.active_at(step.tick)) continue;
    if (!radio.receives(self_.agent, entry.author.agent)) continue;
    // An agent that rests since its admission never broadcasts.
    if (ends.rests(me.mission(), entry.author.agent, me.counted(entry.active_from))) continue;
    // Others get what a resting agent has sent by repairs.
    if (entry.recalled_at(step.roster_revision) && !table_.steps_held(entry.author)) continue;
    if (!table_.holds_due(entry.author, step.counted)) return entry.author.agent;
  }
  return kUnassigned;
}

// ---- repair ----

void CoverageExchange::on(const Digest& theirs, const AgentStep& step, const Participant& me,
                          Instant now) {
  anti_entropy_.on(theirs, table_, me.follower().roster(), now, step.counted, step.roster_revision);
  if (!rests_) return;  // it will broadcast
  const std::int64_t held = table_.steps_held(self_).value_or(0);
  const auto entries =
      std::span(theirs.entries).first(static_cast<std::size_t>(theirs.entry_count));
  own_repeat_wanted_ =
      own_repeat_wanted_ || std::ranges::any_of(entries, [&](const DigestEntry& entry) {
        return entry.author == self_ && entry.steps < held;
      });
}

void CoverageExchange::repair(const std::vector<RosterEntry>& roster, const AgentStep& step,
                              Participant& me, Instant now, Outbox& out) {
  for (const Contribution& block : anti_entropy_.answers_due(table_, now, step.counted)) {
    me.relay(Bus::kSwarm, block, out);
  }
  if (!next_digest_.due(now, step.counted)) return;
  if (std::exchange(own_repeat_wanted_, false)) repeat(me, out);
  next_digest_ =
      Deadline::in(kDigestPeriod, now, kDigestMissionPeriod_s, me.timing().dt_s, step.counted);
  const Digest digest = anti_entropy_.digest(table_, roster, step.counted);
  me.publish(Bus::kSwarm, digest, std::max<Tick>(step.tick, 0), out);
}

Instant CoverageExchange::next_repair() const {
  return std::min(next_digest_.at, anti_entropy_.next_answer());
}

// ---- for the status ----

Tick CoverageExchange::oldest_update_age(const AgentStep& step, const EndSchedule& ends,
                                         const Participant& me) const {
  Tick oldest = 0;
  for (const RosterEntry& entry : me.follower().roster()) {
    if (entry.author == self_ || !entry.active_at(step.tick)) continue;
    if (ends.rests(me.mission(), entry.author.agent, step.counted)) continue;
    if (entry.recalled_at(step.roster_revision)) continue;
    const Tick* const last_update = last_update_.find(entry.author);
    const Tick last = last_update == nullptr ? -1 : *last_update;
    const Tick joined = me.counted(entry.active_from);
    oldest = std::max(oldest, step.counted - std::max(last, joined - 1));
  }
  return oldest;
}

}  // namespace ergocast
