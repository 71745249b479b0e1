// SPDX-License-Identifier: BSD-3-Clause
// A KML file: refused with problems, or polygons of places that exist.
#include "target/geo/kml.h"

#include "tests/fuzz/geo_target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(kml) { require_places(parse_kml(text_of(input))); }

}  // namespace ergocast::fuzz
