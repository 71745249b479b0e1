// SPDX-License-Identifier: BSD-3-Clause
// A GeoJSON file: refused with problems, or polygons of places that exist.
#include "target/geo/geojson.h"

#include "tests/fuzz/geo_target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(geojson) { require_places(parse_geojson(text_of(input))); }

}  // namespace ergocast::fuzz
