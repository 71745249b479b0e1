// SPDX-License-Identifier: BSD-3-Clause
// A table of modes as the bytes of a file, which its hash names.
//
//   header   "ERGOMODE", format, columns, rows, modes, cells, the domain's origin and size,
//            the key of what it was computed from, the version of the program that computed it
//   numbers  owner, place and around (int32), ν and mean squares (double), e_k by cell (float)
//
// All are little-endian, one behind the other, each kind at a multiple of 8 bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "core/basis/free_modes.h"
#include "modes/eigen_modes.h"
#include "modes/free_grid.h"

namespace ergocast {

using ModesTable = std::shared_ptr<const FreeModes>;

/// The bytes of a table.
std::vector<std::byte> encode_table(const FreeGrid& grid, const EigenModes& modes,
                                    std::uint64_t key);

/// The table in these bytes, which point into `storage`. Anybody may have written them. Returns a
/// sentence if they are no table, have another version, or contain a number that no table has.
Result<ModesTable> decode_table(std::span<const std::byte> bytes,
                                std::shared_ptr<const void> storage);

}  // namespace ergocast
