// SPDX-License-Identifier: BSD-3-Clause
// Runs over the modes, row by row of the basis where f is needed.
#include "core/law/forecast_sums.h"

#include <algorithm>

#include "core/base/vectorized.h"
#include "core/basis/free_gains.h"

namespace ergocast::sums {
namespace {

/// Calls each(k, f dt) for every k of the modes, at the place of these cosines.
template <class Each>
ERGOCAST_VECTORIZED_PART void for_gains(const CosinesAt& at, const Basis& basis, double dt_s,
                                        Modes modes, const Each& each) {
  if (at.free.modes != nullptr)
    return for_free_gains(at.free, dt_s, modes.first, modes.first + modes.count, each);
  const int modes_y = basis.modes_y, end = modes.first + modes.count;
  int l = 0, m = modes.first / modes_y;
  int row = m * modes_y;
  for (; m >= basis.modes_x; m -= basis.modes_x) ++l;
  double along_z = at.cos_z[l] * dt_s;
  for (int k = modes.first; k < end; ++m, row += modes_y) {
    if (m == basis.modes_x) {  // the next slab
      m = 0;
      along_z = at.cos_z[++l] * dt_s;
    }
    const int row_end = std::min(row + modes_y, end);
    const double along_x = at.cos_x[m] * along_z;
    ERGOCAST_INDEPENDENT
    for (int n = k - row; n < row_end - row; ++n) each(row + n, along_x * at.cos_y[n]);
    k = row_end;
  }
}

}  // namespace

ERGOCAST_VECTORIZED
void add_gain(const CosinesAt& at, const Basis& basis, double dt_s, Modes modes, double* sums) {
  for_gains(at, basis, dt_s, modes, [=](int k, double gain) { sums[k] += gain; });
}

ERGOCAST_VECTORIZED
void set_gains(const CosinesAt& at, const Basis& basis, double dt_s, const double* g, Modes modes,
               double* gains) {
  for_gains(at, basis, dt_s, modes, [=](int k, double gain) { gains[k] = gain; });
  if (g == nullptr) return;
  ERGOCAST_INDEPENDENT
  for (int k = modes.first; k < modes.first + modes.count; ++k) gains[k] *= g[k];
}

ERGOCAST_VECTORIZED
void add_seen_gain(const CosinesAt& at, const Basis& basis, double dt_s, const double* g,
                   Modes modes, double* sums) {
  for_gains(at, basis, dt_s, modes, [=](int k, double gain) { sums[k] += gain * g[k]; });
}

ERGOCAST_VECTORIZED
void add_weighted(const double* sums, const double* gains, double share, double quality,
                  Modes modes, const double* before, double* sum) {
  ERGOCAST_INDEPENDENT
  for (int k = modes.first; k < modes.first + modes.count; ++k) {
    sum[k] = before[k] + quality * (sums[k] + share * gains[k]);
  }
}

ERGOCAST_VECTORIZED
void add_sums(const double* sums, Modes modes, const double* before, double* sum) {
  ERGOCAST_INDEPENDENT
  for (int k = modes.first; k < modes.first + modes.count; ++k) sum[k] = before[k] + sums[k];
}

ERGOCAST_VECTORIZED
void add_gaining(const double* sums, const double* sums_before, double share, Modes modes,
                 const double* before, double* sum) {
  ERGOCAST_INDEPENDENT
  for (int k = modes.first; k < modes.first + modes.count; ++k) {
    sum[k] = before[k] + (sums[k] + share * (sums[k] - sums_before[k]));
  }
}

ERGOCAST_VECTORIZED
void add_announced(const double* sums, const double* gains, double share, Modes modes,
                   const double* before, double* sum) {
  ERGOCAST_INDEPENDENT
  for (int k = modes.first; k < modes.first + modes.count; ++k) {
    sum[k] = before[k] + (sums[k] + share * gains[k]);
  }
}

ERGOCAST_VECTORIZED
void add_staying(const CosinesAt& at, const Basis& basis, double dt_s, const double* sums,
                 double share, Modes modes, const double* before, double* sum) {
  for_gains(at, basis, dt_s, modes,
            [=](int k, double gain) { sum[k] = before[k] + (sums[k] + share * gain); });
}

ERGOCAST_VECTORIZED
void add_arriving(const CosinesAt& at, const Basis& basis, double dt_s, double* sums, double share,
                  Modes modes, const double* before, double* sum) {
  for_gains(at, basis, dt_s, modes, [=](int k, double gain) {
    sums[k] += gain;
    sum[k] = before[k] + (sums[k] + share * gain);
  });
}

ERGOCAST_VECTORIZED
void average(const double* earlier, const double* later, const double* own, double per_second,
             Modes modes, double* coverage) {
  ERGOCAST_INDEPENDENT
  for (int k = modes.first; k < modes.first + modes.count; ++k) {
    coverage[k] = (earlier[k] + (later[k] + own[k])) * per_second;
  }
}

ERGOCAST_VECTORIZED
void average_weighted(const double* earlier, const double* later, const double* own, double quality,
                      double per_second, Modes modes, double* coverage) {
  ERGOCAST_INDEPENDENT
  for (int k = modes.first; k < modes.first + modes.count; ++k) {
    coverage[k] = (earlier[k] + (later[k] + quality * own[k])) * per_second;
  }
}

}  // namespace ergocast::sums
