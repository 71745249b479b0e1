// SPDX-License-Identifier: BSD-3-Clause
// An ESRI ASCII grid.
#include "target/maps/ascii_grid.h"
#include "tests/fuzz/map_target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(map_ascii) { read_map(input, &open_ascii_grid); }

}  // namespace ergocast::fuzz
