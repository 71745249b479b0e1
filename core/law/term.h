// SPDX-License-Identifier: BSD-3-Clause
// One row's part in one block of a forecast, core/law/forecast.h: q (S + share · gains).
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/ids.h"
#include "core/law/row_track.h"

namespace ergocast {

struct Term {
  // How it counts: equal in all blocks that have the same age.
  RowTrack* track = nullptr;      ///< what extends the row by places; null: it gains by its blocks
  std::int64_t added_steps = 0;   ///< those at places, which extend the row
  double remembered_steps = 0;    ///< the time that its sums cover [steps]
  std::int64_t gained_steps = 0;  ///< those of its gains; 0: no forecast
  double gained_time_steps = 0;   ///< the time that its gains cover [steps]
  Tick tick = 0;                  ///< when its sums were known
  Tick period = 0;                ///< until its author's next broadcast, as announced
  Tick rest_from = std::numeric_limits<Tick>::max();  ///< of its author, core/mission/station.h
  double quality = 1;
  double share = 0;  ///< of the gains

  // Where its numbers of this block are, as tables that begin with the first slot [s]. A row that
  // gains by its blocks has either the sums before or the gains as announced.
  const double* sums = nullptr;
  const double* sums_before = nullptr;
  const double* announced_gains = nullptr;
};

/// The terms of all rows that count.
struct TeamTerms {
  std::vector<Term> earlier, later;  ///< of authors before and after the own one, ascending
  Term own;                          ///< without sums if there is no own row

  void clear() {
    earlier.clear();
    later.clear();
    own = Term();
  }
};

}  // namespace ergocast
