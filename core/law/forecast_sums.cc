// SPDX-License-Identifier: BSD-3-Clause
// Runs over the modes, row by row of the basis where f is needed. What a loop reads is in variables
// of its own, so that it is a vector loop.
#include "core/law/forecast_sums.h"

#include <algorithm>

#include "core/base/vectorized.h"
#include "core/basis/free_gains.h"

namespace ergocast::sums {
namespace {

/// Calls each(k, f dt) for every k of the modes, at this place.
template <class Each>
ERGOCAST_VECTORIZED_PART void for_gains(const PlaceGain& place, Modes modes, const Each& each) {
  const CosinesAt& at = place.at;
  const double dt_s = place.dt_s;
  if (at.free.modes != nullptr)
    return for_free_gains(at.free, dt_s, modes.first, modes.first + modes.count, each);
  const int modes_x = place.basis.modes_x, modes_y = place.basis.modes_y;
  const int end = modes.first + modes.count;
  int l = 0, m = modes.first / modes_y;
  int row = m * modes_y;
  for (; m >= modes_x; m -= modes_x) ++l;
  double along_z = at.cos_z[l] * dt_s;
  for (int k = modes.first; k < end; ++m, row += modes_y) {
    if (m == modes_x) {  // the next slab
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

/// Calls each(k) for every k of the modes.
template <class Each>
ERGOCAST_VECTORIZED_PART void for_modes(Modes modes, const Each& each) {
  ERGOCAST_INDEPENDENT
  for (int k = modes.first; k < modes.first + modes.count; ++k) each(k);
}

}  // namespace

ERGOCAST_VECTORIZED
void set_gains(const PlaceGain& place, Modes modes, double* gains) {
  for_gains(place, modes, [=](int k, double gain) { gains[k] = gain; });
  const double* const g = place.g;
  if (g != nullptr) for_modes(modes, [=](int k) { gains[k] *= g[k]; });
}

ERGOCAST_VECTORIZED
void add_gain(const PlaceGain& place, Modes modes, double* sums) {
  if (const double* const g = place.g) {
    for_gains(place, modes, [=](int k, double gain) { sums[k] += gain * g[k]; });
  } else {
    for_gains(place, modes, [=](int k, double gain) { sums[k] += gain; });
  }
}

ERGOCAST_VECTORIZED
void add_weighted(const double* sums, const double* gains, double share, double quality,
                  const RunningSum& running) {
  const double* const before = running.before;
  double* const sum = running.sum;
  for_modes(running.modes,
            [=](int k) { sum[k] = before[k] + quality * (sums[k] + share * gains[k]); });
}

ERGOCAST_VECTORIZED
void add_sums(const double* sums, const RunningSum& running) {
  const double* const before = running.before;
  double* const sum = running.sum;
  for_modes(running.modes, [=](int k) { sum[k] = before[k] + sums[k]; });
}

ERGOCAST_VECTORIZED
void add_gaining(const double* sums, const double* sums_before, double share,
                 const RunningSum& running) {
  const double* const before = running.before;
  double* const sum = running.sum;
  for_modes(running.modes,
            [=](int k) { sum[k] = before[k] + (sums[k] + share * (sums[k] - sums_before[k])); });
}

ERGOCAST_VECTORIZED
void add_announced(const double* sums, const double* gains, double share,
                   const RunningSum& running) {
  const double* const before = running.before;
  double* const sum = running.sum;
  for_modes(running.modes, [=](int k) { sum[k] = before[k] + (sums[k] + share * gains[k]); });
}

ERGOCAST_VECTORIZED
void add_staying(const PlaceGain& place, const double* sums, double share,
                 const RunningSum& running) {
  const double* const before = running.before;
  double* const sum = running.sum;
  for_gains(place, running.modes,
            [=](int k, double gain) { sum[k] = before[k] + (sums[k] + share * gain); });
}

ERGOCAST_VECTORIZED
void add_arriving(const PlaceGain& place, double* sums, double share, const RunningSum& running) {
  const double* const before = running.before;
  double* const sum = running.sum;
  for_gains(place, running.modes, [=](int k, double gain) {
    sums[k] += gain;
    sum[k] = before[k] + (sums[k] + share * gain);
  });
}

ERGOCAST_VECTORIZED
void average(const TeamParts& team, double per_second, Modes modes, double* coverage) {
  const auto [earlier, later, own] = team;
  ERGOCAST_INDEPENDENT
  for (int k = modes.first; k < modes.first + modes.count; ++k) {
    coverage[k] = (earlier[k] + (later[k] + own[k])) * per_second;
  }
}

ERGOCAST_VECTORIZED
void average_weighted(const TeamParts& team, double own_quality, double per_second, Modes modes,
                      double* coverage) {
  const auto [earlier, later, own] = team;
  ERGOCAST_INDEPENDENT
  for (int k = modes.first; k < modes.first + modes.count; ++k) {
    coverage[k] = (earlier[k] + (later[k] + own_quality * own[k])) * per_second;
  }
}

}  // namespace ergocast::sums
