// SPDX-License-Identifier: BSD-3-Clause
// The modes of a free domain at a place: the loop that takes the time of samples and forecasts.
#pragma once

#include "core/base/vectorized.h"
#include "core/basis/free_modes.h"

namespace ergocast {

/// Calls each(k, e_k · dt_s) for the modes from `first` up to `end`.
template <class Each>
ERGOCAST_VECTORIZED_PART void for_free_gains(const FreePlace& at, double dt_s, int first, int end,
                                             const Each& each) {
  const auto [a, b, c, d] = at.corners;
  const double share_a = at.shares[0] * dt_s, share_b = at.shares[1] * dt_s;
  const double share_c = at.shares[2] * dt_s, share_d = at.shares[3] * dt_s;
  ERGOCAST_INDEPENDENT
  for (int k = first; k < end; ++k)
    each(k, (share_a * a[k] + share_b * b[k]) + (share_c * c[k] + share_d * d[k]));
}

}  // namespace ergocast
