// SPDX-License-Identifier: BSD-3-Clause
// Repairs missing coverage: reads teammates' digests and repeats the blocks of authors that they
// cannot hear. Lost messages, late joiners, restarts, sums of stopped agents and divided teams need
// nothing else.
#pragma once

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
  static constexpr std::size_t kMaxAnswers = 256;

  /// @param seed  of the delays before an answer
  AntiEntropy(const Author& self, std::uint64_t seed, double dt_s)
      : self_(self), seed_(seed), dt_s_(dt_s) {}

  /// What `table` holds of every entry of `roster`, in as many messages as needed, without headers.
  static std::vector<Digest> digests(const CoverageTable& table,
                                     const std::vector<RosterEntry>& roster);

  /// A teammate says what it holds, in ascending order of authors. An author is worth an answer if
  /// in two digests in a row its coverage there was behind ours: by more than two of the author's
  /// broadcast periods, or by any block if the author has left the roster and will not speak again.
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

  void consider(const Author& requester, const Author& author, bool lacks, std::int64_t sequence,
                Instant now, Tick tick);

  bool may_answer(Instant now, Tick tick);

  Author self_;
  std::uint64_t seed_;
  double dt_s_;
  std::map<std::pair<Author, Author>, RowRequest> complaints_;  // (who lacks, whose coverage)
  std::map<Author, Deadline> answers_;
  Deadline next_window_;
  std::size_t window_answers_ = 0;
  std::uint64_t draws_ = 0;
  std::int64_t relayed_ = 0;
};

}  // namespace ergocast
