// SPDX-License-Identifier: BSD-3-Clause
// A table of numbers as a map.
#include "target/maps/csv_map.h"
#include "tests/fuzz/map_target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(map_csv) { read_map(input, &open_csv_map); }

}  // namespace ergocast::fuzz
