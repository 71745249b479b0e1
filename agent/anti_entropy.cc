// SPDX-License-Identifier: BSD-3-Clause
// Compares each digest with the own table and schedules an answer, which a teammate's earlier
// answer cancels.
#include "agent/anti_entropy.h"

#include <algorithm>
#include <chrono>

#include "core/base/noise.h"

namespace ergocast {
namespace {

using namespace std::chrono_literals;

/// An answer waits a random share of this, so that one agent answers before the others.
constexpr double kLongestDelay_s = 0.25;
/// Limit (Team): row requests that an agent remembers from digests. Beyond it: the oldest are
/// forgotten.
constexpr std::size_t kMaxRequests = 8192;
constexpr int kToleratedPeriods = 2;

/// Whether a teammate that holds `steps` and `state_hash` of this row lacks enough for an answer.
bool lacks_something(const CoverageTable& table, std::size_t row, bool will_speak,
                     std::int64_t steps, std::uint64_t state_hash) {
  if (will_speak && table.min_steps(row) <= steps) return false;  // nearly always
  const CoverageTable::RowSummary ours = table.summary_of(row);
  if (will_speak) return ours.steps - steps > kToleratedPeriods * ours.announced_period;
  // Two agents may report equal steps although each holds a block that the other lacks.
  return ours.steps > steps || (state_hash != ours.state_hash && ours.newest_steps > steps);
}

/// Sums, over all former members, a hash of what the table holds of each.
std::uint64_t hash_of_settled(const CoverageTable& table, const std::vector<RosterEntry>& roster) {
  std::uint64_t sum = 0;
  for (const RosterEntry& entry : roster) {
    if (entry.active_until < 0) continue;
    const std::uint64_t mark = table.summary_of(entry.author).state_hash ^ entry.author.incarnation;
    sum += (mark ^ mark >> 32) * 0x9e3779b97f4a7c15;
  }
  return sum;
}

/// Up to `most` of `authors`, which ascend: those after `last`, then from the first one on. An
/// author that joins or leaves in between delays no other's turn.
std::vector<Author> next_in_turn(const std::vector<Author>& authors, std::size_t most,
                                 Author& last) {
  std::vector<Author> next;
  auto at = std::upper_bound(authors.begin(), authors.end(), last);
  while (next.size() < std::min(authors.size(), most)) {
    if (at == authors.end()) at = authors.begin();
    next.push_back(*at++);
  }
  if (!next.empty()) last = next.back();
  return next;
}

}  // namespace

bool AntiEntropy::seems_lacking(const CoverageTable& table, const RosterEntry& entry,
                                Tick tick) const {
  if (entry.author == self_) return false;
  if (entry.active_until >= 0) return settled_differs_;
  const Tick patience = kToleratedPeriods * table.announced_period(entry.author);
  return entry.active_from < tick && !table.holds_due(entry.author, tick - patience);
}

std::vector<Author> AntiEntropy::to_be_named(const CoverageTable& table,
                                             const std::vector<RosterEntry>& roster, Tick tick) {
  constexpr std::size_t kMost = kMaxDigestEntriesPerMessage;
  std::vector<Author> all, lacking;
  for (const RosterEntry& entry : roster) {
    all.push_back(entry.author);
    if (seems_lacking(table, entry, tick)) lacking.push_back(entry.author);
  }
  if (all.size() <= kMost) return all;
  std::vector<Author> named = next_in_turn(lacking, kMost - kInTurn, last_lacking_);
  const std::vector<Author> others = next_in_turn(all, kMost - named.size(), last_);
  named.insert(named.end(), others.begin(), others.end());
  std::sort(named.begin(), named.end());
  named.erase(std::unique(named.begin(), named.end()), named.end());
  return named;
}

Digest AntiEntropy::digest(const CoverageTable& table, const std::vector<RosterEntry>& roster,
                           Tick tick) {
  Digest digest;
  for (const Author& author : to_be_named(table, roster, tick)) {
    const CoverageTable::RowSummary held = table.summary_of(author);
    digest.entries[static_cast<std::size_t>(digest.entry_count++)] = {author, held.steps,
                                                                      held.state_hash};
  }
  digest.settled_hash = settled_hash_ = hash_of_settled(table, roster);
  settled_differs_ = false;
  round_s_ = round_s(roster.size());
  return digest;
}

/// Two requests count as consecutive within this time, which allows for one lost digest. A teammate
/// that was cut off for longer starts anew.
PacingClock::duration AntiEntropy::request_lifetime() const { return seconds(3 + 2 * round_s_); }

void AntiEntropy::on(const Digest& theirs, const CoverageTable& table,
                     const std::vector<RosterEntry>& roster, Instant now, Tick tick,
                     std::int64_t revision) {
  settled_differs_ = settled_differs_ || theirs.settled_hash != settled_hash_;
  const Author requester{theirs.header.sender, theirs.header.incarnation};
  if (requests_.size() >= kMaxRequests) {
    std::erase_if(requests_, [&](const auto& request) {
      return now - request.second.at > request_lifetime();
    });
  }
  // Digest, roster and table all ascend by author: one walk along all three.
  std::size_t row = 0, member = 0;
  for (int i = 0; i < theirs.entry_count; ++i) {
    const auto& [author, steps, state_hash] = theirs.entries[static_cast<std::size_t>(i)];
    while (member < roster.size() && roster[member].author < author) ++member;
    while (row < table.row_count() && table.author(row) < author) ++row;
    if (member == roster.size() || row == table.row_count()) return;
    // We broadcast our own coverage only when it is due: in lockstep, ticks depend on that.
    if (author == self_ || author == requester || roster[member].author != author) continue;
    if (table.author(row) != author) continue;
    const bool will_speak =
        roster[member].active_until < 0 && !roster[member].recalled_at(revision);
    const bool lacks = lacks_something(table, row, will_speak, steps, state_hash);
    consider(theirs.header, author, lacks, now, tick);
  }
}

/// @param digest  by which its sender asks for the row of `author`, or does not
void AntiEntropy::consider(const Header& digest, const Author& author, bool lacks, Instant now,
                           Tick tick) {
  if (!lacks && requests_.empty()) return;
  const auto key = std::pair(Author{digest.sender, digest.incarnation}, author);
  if (!lacks) {
    requests_.erase(key);
    return;
  }
  const auto former = requests_.find(key);
  if (former == requests_.end()) {
    if (requests_.size() < kMaxRequests) requests_.emplace(key, RowRequest{digest.sequence, now});
    return;
  }
  if (digest.sequence <= former->second.sequence) return;
  const bool in_a_row = now - former->second.at <= request_lifetime();
  former->second = {digest.sequence, now};
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
  if (theirs.steps >= table.summary_of(theirs.author()).newest_steps) answers_.erase(planned);
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
