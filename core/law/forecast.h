// SPDX-License-Identifier: BSD-3-Clause
// One agent's forecast of the team's coverage, which its law uses.
//
//   ĉ_i = [Σ_j S_j + Σ_{j≠i} w_j r_j] / [Σ_j T_j + Σ_{j≠i} w_j]
//   r_j = (S_j − S'_j) / (T_j − T'_j), or as j has sent it where averages travel in 16 bits
//
// Each teammate j is assumed to continue for w_j (core/law/look_ahead.h) at its rate since the
// block before. Agents that steer by the team's *past* coverage chase the same deficit. With ĉ,
// each agent leaves to the others what they are about to cover. docs/law_theory.md has the
// derivation, docs/law.md the figures.
//
// With dead reckoning, f at a teammate's known places since its last block is added to its row, and
// r_j is f at the newest place. The row then equals one that was sent there. The table is not
// changed, the forecast is never sent, and the next block replaces these additions.
//
// A teammate that will rest (core/mission/station.h) is assumed to continue no longer than until
// then: h of its w_j is at most that time.
//
// Where kinds differ (core/mission/kinds.h), each row's part has its quality q_j in both sums, and
// f at a place of teammate j is g_j f.
//
// ĉ is a function of the table, the roster and the known places. The order of their arrival does
// not matter: in lockstep all agents that receive the same messages compute the same forecast.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "core/base/ids.h"
#include "core/base/line_aligned.h"
#include "core/basis/basis.h"
#include "core/law/block_layout.h"
#include "core/law/coverage_table.h"
#include "core/law/look_ahead.h"
#include "core/mission/kinds.h"
#include "core/mission/mission.h"
#include "core/mission/roster.h"

namespace ergocast {

class Forecast {
 public:
  /// Places of a vehicle that are kept beyond those of the longest period. A correct agent is
  /// silent for less time than they cover, so a late block loses none.
  /// Limit (Team): positions of a teammate that an agent keeps beyond those of a broadcast period
  /// [steps]. Beyond it: the oldest is forgotten.
  static constexpr Tick kPlacesBeyondPeriod = 64;

  /// Consecutive slots in the order of the wire.
  using Modes = BlockLayout::Slots;

  Forecast(const Mission& mission, const Author& self);

  /// Notes that a vehicle was at `x_m` at `tick`. It has no effect without dead reckoning, for our
  /// own vehicle, for a tick that is already known, and outside the domain.
  void see(AgentId agent, Tick tick, const Eigen::Vector3d& x_m);

  /// ĉ at `tick`; entries of blocks without any samples are 0. A row has a forecast if it counts,
  /// its gains are possible, and its author is active in the roster without a newer incarnation and
  /// does not rest: n is 1 + the number of such rows, for each block. Allocates only for a
  /// teammate's first place and first row.
  void look_ahead(const CoverageTable& table, const std::vector<RosterEntry>& roster, Tick tick,
                  Coefficients& coverage);

 private:
  struct Place {
    Tick tick;
    Eigen::Vector3d x_m;
  };
  /// A row since its last blocks. Places belong to the vehicle, not to an incarnation.
  struct Track {
    std::vector<Place> places;  // ascending by tick; the last most_places_ count
    Author author;              // author of the row that is extended
    Tick active_from = 0;       // of that author, from the roster, …
    int kind = 0;               // … and its kind
    std::uint64_t look = 0;     // value of looks_ when it was last extended
    std::vector<std::int64_t>
        sent_steps;                   // per block: steps of the block that was taken from the row
    std::vector<std::int64_t> steps;  // with the places added since
    std::vector<Tick> until;          // the tick of the last step
    std::vector<char> due;            // whether that step counts, but is not in the sums yet
    AlignedDoubles sums;  // with the places; not set for blocks to which nothing was added
    std::optional<CosinesAt> newest;  // at the newest place, and its tick
    Tick newest_tick = -1;
    AlignedDoubles gains;  // f dt there, by slot; only where that is not the mode
  };
  /// One row's part in one block.
  struct Term {
    // Where the first mode would be. A row that gains has the sums before, or the gains as sent.
    const double *sums, *sums_before, *announced_gains;
    Track* track;                      // null: by its blocks
    std::int64_t steps, gained_steps;  // 0: no forecast
    Tick tick, period;
    double share;  // of the gains
    double quality;
    Tick rest_from;  // of its author, core/mission/station.h
  };

  Track* dead_reckon(const CoverageTable& table, std::size_t row, const RosterEntry& entry);
  void add_place(const Place& place, const CoverageTable& table, std::size_t row, Track& track);
  void add_due_step(Track& track) const;
  void set_gains_in_slots(Track& track);
  const double* gains_of(const Track& track, Modes modes);
  void gather(const CoverageTable& table, const std::vector<RosterEntry>& roster, Tick tick);
  bool uniform_blocks(const CoverageTable& table) const;
  Term term_of(const CoverageTable& table, std::size_t row, int block) const;
  Tick rest_from(AgentId id) const;
  double weigh_terms(const CoverageTable& table, int block, Tick tick);
  void point_terms(const CoverageTable& table, int block);
  void add_up(Modes modes, double per_second, double* coverage);
  void add(const Term& term, Modes modes, const double* before, double* sum);
  void add_weighted(const Term& term, Modes modes, const double* before, double* sum);
  const double* footprint(const Track& track) const {
    return uniform_ ? nullptr : sensors_.of(track.kind).footprint();
  }

  Author self_;
  Box domain_;
  Basis basis_;
  double dt_s_;
  BlockLayout layout_;
  int block_size_;
  LookAhead look_ahead_;
  bool dead_reckons_;
  Sensors sensors_;
  bool uniform_;    // whether all sensors are alike, the usual case
  bool by_tables_;  // slots are not modes: f is computed as a whole, not mode by mode
  std::size_t most_places_;
  std::vector<Tick> rest_from_;  // by number, where any agent has a station
  std::map<AgentId, Track> tracks_;
  std::uint64_t looks_ = 0;            // calls of look_ahead()
  std::vector<Track*> dead_reckoned_;  // per row of the table; null: by its blocks
  std::vector<char> has_forecast_;     // per row: whether it has a forecast
  std::vector<Term> terms_;            // of the other rows that count, ascending by author
  std::ptrdiff_t before_own_ = 0;      // number of terms before the own row
  const double* own_sums_ = nullptr;
  double own_quality_ = 1;
  AlignedDoubles nothing_;  // zeros
  AlignedDoubles gains_;    // of a row whose sensor differs from others
  AlignedDoubles by_slot_;  // ĉ, only where a slot is not the mode
  // What the rows before the own one and those after it will have covered.
  AlignedDoubles earlier_, later_;
};

}  // namespace ergocast
