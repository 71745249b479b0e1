// SPDX-License-Identifier: BSD-3-Clause
// Repairs missing coverage: reads teammates' digests and repeats the blocks of authors that they
// cannot hear. Lost messages, late joiners, restarts, sums of stopped agents and divided teams need
// nothing else.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "core/coverage_table.h"
#include "core/ids.h"
#include "team/deadline.h"
#include "team/messages.h"

namespace ergocast {

class AntiEntropy {
 public:
  /// Rows that are about to be repeated at any time, and rows that it takes up in a second, by the
  /// clock or of the mission, whatever digests say.
  /// Limit (Team): rows of coverage that an agent repeats at a time, and in a second. Beyond it:
  /// the next digest asks again.
  static constexpr std::size_t kMaxAnswers = 256;

  /// @param seed  of the delays before an answer
  AntiEntropy(const Author& self, std::uint64_t seed, double dt_s)
      : self_(self), seed_(seed), dt_s_(dt_s) {}

  /// The entries of a larger roster that a digest names whatever they are. The others are those
  /// that we seem to lack.
  static constexpr std::size_t kInTurn = kMaxDigestEntriesPerMessage / 2;

  /// How long it takes at most until digests, one a second, have named every entry of a roster.
  static constexpr double round_s(std::size_t entries) {
    if (entries <= kMaxDigestEntriesPerMessage) return 1;
    const std::size_t rounds = (entries + kInTurn - 1) / kInTurn;
    return static_cast<double>(rounds);
  }

  /// What `table` holds of the entries of `roster`, without header: of all, or of a roster that is
  /// larger than a message, of entries in turn. Half of these are such as we seem to lack: coverage
  /// that is overdue at `tick`, and that of former members if a teammate's settled_hash differs
  /// from ours.
  Digest digest(const CoverageTable& table, const std::vector<RosterEntry>& roster, Tick tick);

  /// A teammate says what it holds, in ascending order of authors. An author is worth an answer if
  /// twice in a row its coverage there was behind ours: by more than two of the author's broadcast
  /// periods, or by any block if the author has left the roster and will not speak again.
  void on(const Digest& theirs, const CoverageTable& table, const std::vector<RosterEntry>& roster,
          Instant now, Tick tick);

  /// Another agent has repeated `theirs`: if it is as new as ours, we do not repeat it.
  void on_relayed(const Contribution& theirs, const CoverageTable& table);

  /// The blocks to be repeated now, as their authors said them.
  std::vector<Contribution> answers_due(const CoverageTable& table, Instant now, Tick tick);

  /// When answers_due() should be asked next.
  Instant next_answer() const;

  std::int64_t relayed() const { return relayed_; }

 private:
  struct RowRequest {
    std::int64_t sequence;  // of the digest it was in
    Instant at;
  };

  bool seems_lacking(const CoverageTable& table, const RosterEntry& entry, Tick tick) const;
  std::vector<Author> to_be_named(const CoverageTable& table,
                                  const std::vector<RosterEntry>& roster, Tick tick);
  void consider(const Author& requester, const Author& author, bool lacks, std::int64_t sequence,
                Instant now, Tick tick);
  PacingClock::duration request_lifetime() const;
  bool may_answer(Instant now, Tick tick);

  Author self_;
  std::uint64_t seed_;
  double dt_s_;
  std::map<std::pair<Author, Author>, RowRequest> requests_;  // (who lacks, whose coverage)
  std::map<Author, Deadline> answers_;
  Author last_, last_lacking_;      // the last that were named in turn
  std::uint64_t settled_hash_ = 0;  // as our last digest said
  bool settled_differs_ = false;    // from a teammate's, since then
  double round_s_ = 1;              // of the roster as we last heard of it
  Deadline next_window_;
  std::size_t window_answers_ = 0;
  std::uint64_t draws_ = 0;
  std::int64_t relayed_ = 0;
};

}  // namespace ergocast
