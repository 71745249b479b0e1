// SPDX-License-Identifier: BSD-3-Clause
// The additions that a forecast is made of, over some modes: the loops that take its time.
//
// `sum` is a running sum over rows. `before` is its value before this row, and may be the same
// table. All tables begin with the first mode of the basis. Each mode is computed by itself and in
// one order, so a vector of modes gives the same bits as one mode.
#pragma once

#include "core/basis/basis.h"
#include "core/law/forecast.h"

namespace ergocast::sums {

using Modes = Forecast::Modes;

/// S += f dt.
void add_gain(const CosinesAt& at, const Basis& basis, double dt_s, Modes modes, double* sums);

/// gains = g f dt; g may be null, for 1.
void set_gains(const CosinesAt& at, const Basis& basis, double dt_s, const double* g, Modes modes,
               double* gains);

/// S += g f dt.
void add_seen_gain(const CosinesAt& at, const Basis& basis, double dt_s, const double* g,
                   Modes modes, double* sums);

/// sum = before + q (S + share · gains).
void add_weighted(const double* sums, const double* gains, double share, double quality,
                  Modes modes, const double* before, double* sum);

/// sum = before + S.
void add_sums(const double* sums, Modes modes, const double* before, double* sum);

/// sum = before + S + share · (S − S').
void add_gaining(const double* sums, const double* sums_before, double share, Modes modes,
                 const double* before, double* sum);

/// sum = before + S + share · gains.
void add_announced(const double* sums, const double* gains, double share, Modes modes,
                   const double* before, double* sum);

/// sum = before + S + share · f dt.
void add_staying(const CosinesAt& at, const Basis& basis, double dt_s, const double* sums,
                 double share, Modes modes, const double* before, double* sum);

/// S += f dt, and then sum = before + S + share · f dt.
void add_arriving(const CosinesAt& at, const Basis& basis, double dt_s, double* sums, double share,
                  Modes modes, const double* before, double* sum);

/// coverage = (earlier + (later + own)) · per_second.
void average(const double* earlier, const double* later, const double* own, double per_second,
             Modes modes, double* coverage);

/// coverage = (earlier + (later + q own)) · per_second.
void average_weighted(const double* earlier, const double* later, const double* own, double quality,
                      double per_second, Modes modes, double* coverage);

}  // namespace ergocast::sums
