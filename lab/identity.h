// SPDX-License-Identifier: BSD-3-Clause
// The identities of simulated runs and processes, which follow from the mission's seed.
#pragma once

#include <cstdint>

#include "core/base/ids.h"
#include "core/base/noise.h"
#include "core/mission/mission.h"

namespace ergocast::lab {

/// Start number `start` of process `who`.
inline Incarnation identity(const Mission& mission, std::uint32_t who, std::uint32_t start) {
  return random_words(mission.seed, Purpose::kIncarnation, who, start).first | 1;
}

inline RunId simulated_run(const Mission& mission) { return identity(mission, ~0U, 0); }

}  // namespace ergocast::lab
