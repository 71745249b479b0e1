// SPDX-License-Identifier: BSD-3-Clause
// Repairs missing coverage: reads teammates' digests and repeats the blocks that they lack. This
// suffices for lost messages, late joiners, restarts, sums of stopped agents and divided teams.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/base/ids.h"
#include "core/law/coverage_table.h"
#include "team/deadline.h"
#include "team/messages.h"

namespace ergocast {

class AntiEntropy {
 public:
  /// Limits the rows that wait for their repetition. Limits also the rows that are accepted for it
  /// in a second, by the clock or of the mission.
  /// Limit (Team): rows of coverage that an agent repeats at a time, and in a second. Beyond it:
  /// the next digest asks again.
  static constexpr std::size_t kMaxAnswers = 256;

  /// @param seed  of the delays before an answer
  AntiEntropy(const Author& self, std::uint64_t seed, double dt_s)
      : self_(self), seed_(seed), dt_s_(dt_s) {}

  /// A roster may be larger than a digest. Then so many of the digest's entries are taken in turn;
  /// the others are those that we seem to lack.
  static constexpr std::size_t kInTurn = kMaxDigestEntriesPerMessage / 2;

  /// The longest time until digests, one a second, have named every entry of a roster.
  static constexpr double round_s(std::size_t entries) {
    if (entries <= kMaxDigestEntriesPerMessage) return 1;
    const std::size_t rounds = (entries + kInTurn - 1) / kInTurn;
    return static_cast<double>(rounds);
  }

  /// What `table` holds of the entries of `roster`, without header. If the roster is larger than a
  /// message, entries are named in turn. Up to half of them are those that we seem to lack. We seem
  /// to lack coverage that is overdue at `tick`. If a teammate's settled_hash differs from ours, we
  /// also seem to lack coverage of former members.
  Digest digest(const CoverageTable& table, const std::vector<RosterEntry>& roster, Tick tick);

  /// Takes in what a teammate holds, in ascending order of authors. An author's row is answered if
  /// the teammate was behind ours in two consecutive digests. Behind means by more than two of the
  /// author's broadcast periods, or by any block if the author has left the roster or rests.
  /// @param revision  of the roster that the world uses; it decides which recalled agents rest
  void on(const Digest& theirs, const CoverageTable& table, const std::vector<RosterEntry>& roster,
          Instant now, Tick tick, std::int64_t revision = 0);

  /// Another agent has repeated `theirs`. If it is as new as ours, we do not repeat it.
  void on_relayed(const Contribution& theirs, const CoverageTable& table);

  /// The blocks to be repeated now, as their authors sent them.
  std::vector<Contribution> answers_due(const CoverageTable& table, Instant now, Tick tick);

  /// When answers_due() should be called next.
  Instant next_answer() const;

  std::int64_t relayed() const { return relayed_; }

 private:
  struct RowRequest {
    std::int64_t sequence;  // of the digest that made the request
    Instant at;
  };

  bool seems_lacking(const CoverageTable& table, const RosterEntry& entry, Tick tick) const;
  std::vector<Author> to_be_named(const CoverageTable& table,
                                  const std::vector<RosterEntry>& roster, Tick tick);
  void consider(const Header& digest, const Author& author, bool lacks, Instant now, Tick tick);
  PacingClock::duration request_lifetime() const;
  bool may_answer(Instant now, Tick tick);

  Author self_;
  std::uint64_t seed_;
  double dt_s_;
  std::map<std::pair<Author, Author>, RowRequest> requests_;  // by (requester, author)
  std::map<Author, Deadline> answers_;
  Author last_, last_lacking_;      // the last that were named in turn
  std::uint64_t settled_hash_ = 0;  // in our last digest
  bool settled_differs_ = false;    // a teammate's hash has differed since then
  double round_s_ = 1;              // round_s() of the roster in our last digest
  Deadline next_window_;
  std::size_t window_answers_ = 0;
  std::uint64_t draws_ = 0;
  std::int64_t relayed_ = 0;
};

}  // namespace ergocast
