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
// then: h of its w_j is at most that time. One whose battery is charged has no forecast meanwhile.
//
// Where kinds differ (core/mission/kinds.h), each row's part has its quality q_j in both sums, and
// f at a place of teammate j is g_j f.
//
// After a change of the target (core/law/target_shift.h) a row's gains still contain the former
// shift for its steps before the change, while the teammate will add the present one. The forecast
// corrects them by the known difference. The added places get the shifts of their ticks.
//
// ĉ is a function of the table, the roster and the known places. The order of their arrival does
// not matter: in lockstep all agents that receive the same messages compute the same forecast.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <vector>

#include "core/base/ids.h"
#include "core/base/line_aligned.h"
#include "core/basis/basis.h"
#include "core/law/block_layout.h"
#include "core/law/coverage_table.h"
#include "core/law/look_ahead.h"
#include "core/law/row_track.h"
#include "core/law/sampling.h"
#include "core/law/target_shift.h"
#include "core/law/team_sum.h"
#include "core/law/term.h"
#include "core/mission/end_schedule.h"
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

  Forecast(const Mission& mission, const Author& self);

  /// Notes that a vehicle was at `x_m` at `tick`. It has no effect without dead reckoning, for our
  /// own vehicle, for a tick that is already known, and outside the domain.
  /// @param charges  its battery is charged: the place is not covered, and its agent rests until a
  ///                 later tick shows otherwise; also without dead reckoning
  void see(AgentId agent, Tick tick, const Eigen::Vector3d& x_m, bool charges = false);

  /// The revision of the roster that the world uses from now on: it decides which of the recalled
  /// agents rest.
  void note_revision(std::int64_t revision) { revision_ = revision; }

  /// Takes in the end that holds at a counted tick. Does not allocate.
  void note_ends(const Mission& mission, const EndSchedule& ends, Tick counted);

  /// The changes of the target. It outlives the next call of look_ahead().
  void note_shift(const TargetShift& shift) { shift_ = shift.any_of_samples() ? &shift : nullptr; }

  /// ĉ at `tick`; entries of blocks without any samples are 0. A row has a forecast if it counts,
  /// its gains are possible, and its author is active in the roster without a newer incarnation and
  /// does not rest: n is 1 + the number of such rows, for each block. Allocates only for a
  /// teammate's first place and first row.
  void look_ahead(const CoverageTable& table, const std::vector<RosterEntry>& roster, Tick tick,
                  Coefficients& coverage);

 private:
  /// How a row of the table is forecast.
  struct Outlook {
    bool any = false;           // whether it has a forecast
    RowTrack* track = nullptr;  // what extends it by places; null: nothing is known of its vehicle
    /// Whether places are newer than a block that was sent at `tick`.
    bool by_places(Tick tick) const { return track != nullptr && track->newest_tick() >= tick; }
  };

  /// How much of the shift of each change the sums of a block lack [s]; core/law/target_shift.h.
  using Correction = std::array<double, TargetShift::kMostChanges>;

  void gather(const CoverageTable& table, const std::vector<RosterEntry>& roster, Tick tick);
  RowTrack* extended_track(const CoverageTable& table, std::size_t row, const RosterEntry& entry);
  bool uniform_blocks(const CoverageTable& table) const;
  Term term_of(const CoverageTable& table, std::size_t row, int block) const;
  Tick rest_from(AgentId id) const;
  bool charges(AgentId id) const;
  double weigh_terms(const CoverageTable& table, int block, Tick tick);
  Correction correction(const CoverageTable& table, int block, Tick tick) const;
  void add_steps(Tick newest, std::int64_t steps, std::int64_t halvings, double each_s,
                 Correction& sum) const;
  void add_correction(const Term& term, Tick sent, Tick tick, std::int64_t halvings,
                      Correction& sum) const;
  void correct(const Correction& correction, int block, double per_second, double* coverage) const;
  double weigh(Term& term, double horizon_s, Tick tick) const;
  void point_terms(const CoverageTable& table, int block);
  void point(Term& term, const CoverageTable& table, std::size_t row, int block) const;

  Author self_;
  Sampling sampling_;
  LookAhead look_ahead_;
  HalfLife half_life_;
  bool dead_reckons_;
  std::size_t most_places_;
  std::int64_t revision_ = 0;
  const TargetShift* shift_ = nullptr;  // null: no target has changed
  std::vector<Tick> rest_from_;         // by number, where any agent has a station
  struct Charge {
    Tick tick = -1;
    bool goes_on = false;
  };
  std::vector<Charge> charges_;  // of the newest known place, by number; where there are batteries
  std::map<AgentId, RowTrack> tracks_;
  std::uint64_t looks_ = 0;        // calls of look_ahead()
  std::vector<Outlook> outlooks_;  // per row of the table
  TeamTerms terms_;
  TeamSum team_sum_;
  AlignedDoubles by_slot_;  // ĉ, only where a slot is not the mode
};

}  // namespace ergocast
