// The team's coverage as one agent foresees it: what its law answers to, beside what is known.
//
//   ĉ_i = [Σ_j S_j + Σ_{j≠i} w_j r_j] / [Σ_j T_j + Σ_{j≠i} w_j]
//   r_j = (S_j − S'_j) / (T_j − T'_j)
//
// Each teammate j goes on for w_j as it did since the block before (core/look_ahead.h has w_j).
// Where agents steer by what the team *has* covered, several chase the same deficit; by ĉ, each
// leaves to the others what they are about to cover. docs/law_theory.md has the derivation,
// docs/law.md what it is worth.
//
// With dead reckoning, f at the places where a teammate is known to have been since its last block
// is added to its row, and r_j is f at the newest of them: a row is then as good as one said there.
// Rows stay the truth. What is foreseen is never said to anybody, and the next block replaces it.
//
// ĉ is a function of the table, the roster and the places known, whatever the order in which they
// came: in lockstep all who hear the same foresee the same.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "core/basis.h"
#include "core/coverage_table.h"
#include "core/ids.h"
#include "core/look_ahead.h"
#include "core/messages.h"
#include "core/mission.h"

namespace ergocast {

class Forecast {
 public:
  /// So many places of a vehicle are kept beyond those of the longest period: more than any honest
  /// silence has, so that a late block loses none.
  static constexpr Tick kPlacesBeyondPeriod = 64;

  /// Consecutive modes in the order of the wire.
  struct Modes {
    int first, count;
  };

  Forecast(const Mission& mission, const Author& self);

  /// A vehicle was at `x_m` at `tick`. Without effect: without dead reckoning, for our own vehicle,
  /// for a tick that is no news, outside the domain.
  void see(AgentId agent, Tick tick, const Eigen::Vector2d& x_m);

  /// ĉ at `tick`; entries of blocks that nobody has covered are 0. A row has a forecast if the
  /// roster has its author active and nobody newer under its number, it counts, and its gains are
  /// possible: n is 1 + their number, for each block. Allocates for a teammate's first place and
  /// first row only.
  void look_ahead(const CoverageTable& table, const std::vector<RosterEntry>& roster, Tick tick,
                  Coefficients& coverage);

 private:
  struct Place {
    Tick tick;
    Eigen::Vector2d x_m;
  };
  /// A row since its last blocks. Places are of the vehicle, whoever drives it.
  struct Track {
    std::vector<Place> places;             // ascending by tick; the last most_places_ count
    Author author;                         // whose row is reckoned
    std::vector<std::int64_t> said_steps;  // per block, of the block that was taken from the row
    std::vector<std::int64_t> steps;       // with the places added since
    std::vector<Tick> until;               // the tick of the last step
    std::vector<char> due;                 // whether that one counts, but is not in the sums yet
    std::vector<double> sums;  // with the places; of blocks to which nothing was added, anything
    std::optional<CosinesAt> newest;  // at the newest place, and its tick
    Tick newest_tick = -1;
  };
  /// One row's part in one block.
  struct Term {
    const double *sums, *gains;        // from the mode 0, 0 on
    Track* track;                      // null: by its blocks
    std::int64_t steps, gained_steps;  // 0: no forecast
    Tick tick, period;
    double share;  // of the gains
  };

  Track* reckon(const CoverageTable& table, std::size_t row, const RosterEntry& entry);
  void add_place(const Place& place, const CoverageTable& table, std::size_t row,
                 Track& track) const;
  void add_what_is_due(Track& track) const;
  void gather(const CoverageTable& table, const std::vector<RosterEntry>& roster, Tick tick);
  bool blocks_alike(const CoverageTable& table) const;
  Term term_of(const CoverageTable& table, std::size_t row, int block) const;
  double weigh_terms(const CoverageTable& table, int block, Tick tick);
  void add_up(Modes modes, double per_second, double* coverage);
  void add(const Term& term, Modes modes, const double* before, double* sum) const;
  Modes modes_of(int block, int count) const;

  Author self_;
  Rectangle domain_;
  Basis basis_;
  double dt_s_;
  LookAhead look_ahead_;
  bool reckons_;
  std::size_t most_places_;
  std::map<AgentId, Track> tracks_;
  std::vector<Track*> reckoned_;   // per row of the table; null: by its blocks
  std::vector<char> flies_;        // per row: whether it has a forecast
  std::vector<Term> terms_;        // of the other rows that count, ascending by author
  std::ptrdiff_t before_own_ = 0;  // so many of them come before the own row
  const double* own_sums_ = nullptr;
  std::vector<double> nothing_;  // zeros
  // What the rows before the own one and those after it will have covered.
  std::vector<double> earlier_, later_;
};

}  // namespace ergocast
