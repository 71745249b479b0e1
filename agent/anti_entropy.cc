// SPDX-License-Identifier: BSD-3-Clause
// Compares each digest with the own table and schedules an answer after a random delay, which a
// teammate's earlier answer cancels.
#include "agent/anti_entropy.h"

#include <algorithm>
#include <chrono>

#include "core/noise.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

/// An answer waits a random share of this, so that one of many answers first.
constexpr double kLongestDelay_s = 0.25;
/// Two complaints further apart are not in a row: a teammate that was cut off starts anew.
constexpr auto kComplaintLife = 5s;
constexpr std::size_t kMaxComplaints = 8192;
constexpr int kToleratedPeriods = 2;

/// Whether who holds `steps` and `state_hash` of a row of ours is worth an answer.
bool lacks_something(const CoverageTable& table, std::size_t row, bool will_speak,
                     std::int64_t steps, std::uint64_t state_hash) {
  if (will_speak && table.min_steps(row) <= steps) return false;  // nearly always
  const CoverageTable::RowSummary ours = table.holding(row);
  if (will_speak) return ours.steps - steps > kToleratedPeriods * ours.announced_period;
  // Two may each hold a block that the other lacks, and both say the same number of steps.
  return ours.steps > steps || (state_hash != ours.state_hash && ours.newest_steps > steps);
}

}  // namespace

std::vector<Digest> AntiEntropy::digests(const CoverageTable& table,
                                         const std::vector<RosterEntry>& roster) {
  std::vector<Digest> digests;
  for (const RosterEntry& entry : roster) {
    if (digests.empty() || digests.back().entry_count == kMaxDigestEntriesPerMessage) {
      digests.emplace_back();
    }
    Digest& digest = digests.back();
    const CoverageTable::RowSummary held = table.holding(entry.author);
    digest.entries[static_cast<std::size_t>(digest.entry_count++)] = {entry.author, held.steps,
                                                                      held.state_hash};
  }
  return digests;
}

void AntiEntropy::on(const Digest& theirs, const CoverageTable& table,
                     const std::vector<RosterEntry>& roster, Instant now, Tick tick) {
  const Author requester{theirs.header.sender, theirs.header.incarnation};
  if (complaints_.size() >= kMaxComplaints) {
    std::erase_if(complaints_, [now](const auto& complaint) {
      return now - complaint.second.at > kComplaintLife;
    });
  }
  // Digest, roster and table all ascend by author: one walk along all three.
  std::size_t row = 0, member = 0;
  for (int i = 0; i < theirs.entry_count; ++i) {
    const auto& [author, steps, state_hash] = theirs.entries[static_cast<std::size_t>(i)];
    while (member < roster.size() && roster[member].author < author) ++member;
    while (row < table.row_count() && table.author(row) < author) ++row;
    if (member == roster.size() || row == table.row_count()) return;
    // Our own coverage we broadcast as it grows, never in between: in lockstep, ticks depend on it.
    if (author == self_ || author == requester || roster[member].author != author) continue;
    if (table.author(row) != author) continue;
    const bool will_speak = roster[member].active_until < 0;
    const bool lacks = lacks_something(table, row, will_speak, steps, state_hash);
    consider(requester, author, lacks, theirs.header.sequence, now, tick);
  }
}

void AntiEntropy::consider(const Author& requester, const Author& author, bool lacks,
                           std::int64_t sequence, Instant now, Tick tick) {
  if (!lacks && complaints_.empty()) return;
  const auto key = std::pair(requester, author);
  if (!lacks) {
    complaints_.erase(key);
    return;
  }
  const auto former = complaints_.find(key);
  if (former == complaints_.end()) {
    if (complaints_.size() < kMaxComplaints) complaints_.emplace(key, RowRequest{sequence, now});
    return;
  }
  if (sequence <= former->second.sequence) return;
  const bool in_a_row = now - former->second.at <= kComplaintLife;
  former->second = {sequence, now};
  if (!in_a_row || answers_.count(author) != 0 || !may_answer(now, tick)) return;
  const double delay_s =
      kLongestDelay_s *
      uniform_pair(seed_, Purpose::kAnswer, static_cast<std::uint32_t>(self_.agent), ++draws_).x();
  answers_.emplace(author, Deadline::in(seconds(delay_s), now, delay_s, dt_s_, tick));
}

bool AntiEntropy::may_answer(Instant now, Tick tick) {
  if (next_window_.due(now, tick)) {
    next_window_ = Deadline::in(1s, now, 1, dt_s_, tick);
    window_answers_ = 0;
  }
  if (answers_.size() >= kMaxAnswers || window_answers_ >= kMaxAnswers) return false;
  ++window_answers_;
  return true;
}

void AntiEntropy::on_relayed(const Contribution& theirs, const CoverageTable& table) {
  const auto planned = answers_.find(theirs.author());
  if (planned == answers_.end()) return;
  if (theirs.steps >= table.holding(theirs.author()).newest_steps) answers_.erase(planned);
}

std::vector<Contribution> AntiEntropy::answers_due(const CoverageTable& table, Instant now,
                                                   Tick tick) {
  std::vector<Contribution> blocks;
  for (auto at = answers_.begin(); at != answers_.end();) {
    if (!at->second.due(now, tick)) {
      ++at;
      continue;
    }
    for (int b = 0; b < table.block_count(); ++b) {
      Contribution block = table.block(at->first, b);
      if (block.steps > 0) blocks.push_back(block);
    }
    at = answers_.erase(at);
  }
  relayed_ += static_cast<std::int64_t>(blocks.size());
  return blocks;
}

Instant AntiEntropy::next_answer() const {
  Instant next = Instant::max();
  for (const auto& [author, deadline] : answers_) next = std::min(next, deadline.at);
  return next;
}

}  // namespace ergocast
