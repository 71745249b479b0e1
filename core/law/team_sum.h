// SPDX-License-Identifier: BSD-3-Clause
// Adds up the terms of a team (core/law/term.h), block by block.
#pragma once

#include "core/base/line_aligned.h"
#include "core/law/forecast_sums.h"
#include "core/law/sampling.h"
#include "core/law/term.h"

namespace ergocast {

class TeamSum {
 public:
  explicit TeamSum(const BlockLayout& layout);

  /// Sets one block of `coverage` to Σ q (S + share · gains) · per_second over the terms. It also
  /// adds to each row's track (core/law/row_track.h) the step that this block still lacks.
  /// @param coverage  a number for each slot
  void average(const TeamTerms& terms, const Sampling& sampling, int block, double per_second,
               double* coverage);

 private:
  void add(const Term& term, const Sampling& sampling, int block, const sums::RunningSum& running);
  void add_by_gains(const Term& term, const Sampling& sampling, int block,
                    const sums::RunningSum& running);
  const double* gains_of(const Term& term, const Sampling& sampling, sums::Modes modes);

  AlignedDoubles nothing_;          // zeros
  AlignedDoubles row_gains_;        // of the row that add_by_gains() adds
  AlignedDoubles earlier_, later_;  // sums of the rows before the own one, and of those after it
};

}  // namespace ergocast
