// SPDX-License-Identifier: BSD-3-Clause
// The additions that a forecast is made of, over some modes: the loops that take its time.
//
// All tables begin with the first mode of the basis. Each mode is computed by itself and in one
// order, so a vector of modes gives the same bits as one mode.
#pragma once

#include "core/basis/basis.h"
#include "core/law/block_layout.h"

namespace ergocast::sums {

using Modes = BlockLayout::Slots;

/// What a place adds to a row in one step: g f dt. It refers to what it was made from.
struct PlaceGain {
  const CosinesAt& at;
  const Basis& basis;
  double dt_s;
  const double* g;  ///< null: 1
};

/// A running sum over rows. What is added to `before` becomes `sum`; both may be the same table.
struct RunningSum {
  Modes modes;
  const double* before;
  double* sum;
};

/// gains = g f dt.
void set_gains(const PlaceGain& place, Modes modes, double* gains);

/// S += g f dt.
void add_gain(const PlaceGain& place, Modes modes, double* sums);

/// before + q (S + share · gains).
void add_weighted(const double* sums, const double* gains, double share, double quality,
                  const RunningSum& running);

/// before + S.
void add_sums(const double* sums, const RunningSum& running);

/// before + S + share · (S − S').
void add_gaining(const double* sums, const double* sums_before, double share,
                 const RunningSum& running);

/// before + S + share · gains.
void add_announced(const double* sums, const double* gains, double share,
                   const RunningSum& running);

/// before + S + share · f dt.
/// @pre place.g is null
void add_staying(const PlaceGain& place, const double* sums, double share,
                 const RunningSum& running);

/// S += f dt, and then before + S + share · f dt.
/// @pre place.g is null
void add_arriving(const PlaceGain& place, double* sums, double share, const RunningSum& running);

/// The sums of a team in three parts.
struct TeamParts {
  const double *earlier, *later, *own;
};

/// coverage = (earlier + (later + own)) · per_second.
void average(const TeamParts& team, double per_second, Modes modes, double* coverage);

/// coverage = (earlier + (later + q own)) · per_second.
void average_weighted(const TeamParts& team, double own_quality, double per_second, Modes modes,
                      double* coverage);

}  // namespace ergocast::sums
