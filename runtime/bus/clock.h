// SPDX-License-Identifier: BSD-3-Clause
// The only place where this process reads the monotonic clock for pacing.
#pragma once

#include <chrono>

#include "core/base/ids.h"

namespace ergocast {

inline Instant now() {
  return Instant(std::chrono::duration_cast<std::chrono::nanoseconds>(
      std::chrono::steady_clock::now().time_since_epoch()));
}

}  // namespace ergocast
