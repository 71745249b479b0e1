// SPDX-License-Identifier: BSD-3-Clause
// Identities of processes, runs and datagrams.
#pragma once

#include <cstdint>

namespace ergocast {

/// 64 random bits from the operating system, not 0.
std::uint64_t random_identity();

}  // namespace ergocast
