// SPDX-License-Identifier: BSD-3-Clause
// One row for all members of a site: what a site's parent sends to agents of other sites.
//
//   S_s = Σ_j q_j S_j,   T_s = Σ_j q_j T_j,   R_s = Σ_j q_j r_j,   Q_s = Σ_j q_j
//   ℓ_s = Σ_j q_j ℓ_j / Q_s,   ℓ_j = min(span_j, cap) + age_j
//
// The first two are over all members' rows of the site, the others over those with a forecast
// (core/law/forecast.h). A member's row has the samples that one incarnation takes between two
// changes of its site, so the rows of an incarnation share no sample. A site's row lists how many
// steps it has of each. docs/law_theory.md has the proof that no sample counts twice.
//
// A row has one block of modes, as contributions do: each block of a mission has its own.
#pragma once

#include <compare>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "core/base/line_aligned.h"

namespace ergocast {

/// Members' rows in a site's row, those of former members included. Beyond it a further member's
/// row is not summed up, and its coverage counts only at its own site.
inline constexpr std::size_t kMostMemberRows = 1024;

/// The name of a member's row.
struct MemberRowName {
  Author author;
  std::int64_t revision = 0;  ///< of the roster that gave the author this site
  auto operator<=>(const MemberRowName&) const = default;
};

/// How much of a member's row a site's row has.
struct MemberSteps {
  MemberRowName row;
  std::int64_t steps = 0;
  bool operator==(const MemberSteps&) const = default;
};

/// A member's row as its site's parent holds it.
struct MemberRow {
  MemberRowName name;
  std::int64_t steps = 0;
  double elapsed_s = 0;          ///< T_j, the time that its sums cover
  double quality = 1;            ///< q_j
  const double* sums = nullptr;  ///< S_j [s]
  /// What it gains in `gained_s` seconds [s]; null: it has no forecast, but may count in n.
  const double* gains = nullptr;
  double gained_s = 0;
  double lag_s = 0;             ///< ℓ_j
  bool counts_in_team = false;  ///< whether n of the horizon counts it
};

/// Which of two rows of a site is newer. A greater one replaces a smaller one whole.
struct SiteRowOrder {
  std::int64_t revision = 0;  ///< that named the parent
  Author parent;
  std::int64_t steps = 0;  ///< of all members' rows together
  Tick tick = 0;           ///< at which the parent summed up
  auto operator<=>(const SiteRowOrder&) const = default;
};

class SiteRow {
 public:
  /// An empty row of site `site` with room for `modes` sums. Nothing else allocates.
  SiteRow(int site, int modes);

  /// Drops all members' rows. The parent, which `revision` has named, begins to sum up at `tick`.
  void restart(std::int64_t revision, const Author& parent, Tick tick);

  /// Adds one member's row. Names must ascend, because the order of additions decides the bits.
  /// @return whether the row is in the sums: it has steps, a greater name than those before it, and
  ///         room
  bool add(const MemberRow& member);

  int site() const { return site_; }
  int modes() const { return modes_; }
  const SiteRowOrder& order() const { return order_; }
  std::span<const MemberSteps> members() const { return members_; }

  /// S_s [s], modes() numbers, and T_s [s].
  const double* sums() const { return numbers_.data(); }
  double elapsed_s() const { return elapsed_s_; }
  /// R_s, modes() numbers, Q_s, and ℓ_s [s].
  const double* rates() const { return numbers_.data() + modes_; }
  double rate_quality() const { return rate_quality_; }
  double lag_s() const { return rate_quality_ > 0 ? lag_sum_s_ / rate_quality_ : 0; }
  /// m_s: the members that n of the horizon counts.
  int team_size() const { return team_size_; }

  /// Whether honest members can have covered this: |S_s| ≤ T_s and |R_s| ≤ Q_s, up to rounding, and
  /// no time is negative.
  bool is_possible() const;

 private:
  int site_, modes_;
  SiteRowOrder order_;
  std::vector<MemberSteps> members_;  // ascending; its capacity is kMostMemberRows
  AlignedDoubles numbers_;            // S_s, then R_s
  double elapsed_s_ = 0, rate_quality_ = 0, lag_sum_s_ = 0;
  int team_size_ = 0;
};

}  // namespace ergocast
