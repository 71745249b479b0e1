// SPDX-License-Identifier: BSD-3-Clause
// Asks the kernel for random bits.
#include "runtime/bus/random_identity.h"

#include <sys/random.h>

namespace ergocast {

std::uint64_t random_identity() {
  std::uint64_t bits = 0;
  while (bits == 0) {
    if (getrandom(&bits, sizeof bits, 0) != static_cast<ssize_t>(sizeof bits)) bits = 0;
  }
  return bits;
}

}  // namespace ergocast
