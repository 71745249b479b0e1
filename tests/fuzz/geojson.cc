// SPDX-License-Identifier: BSD-3-Clause
// A GeoJSON file: refused with a problem, or polygons of places that exist.
#include "target/geo/geojson.h"

#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(geojson) {
  const auto parsed = parse_geojson(text_of(input));
  if (!parsed) {
    ERGOCAST_REQUIRE(!parsed.error().what.empty() && !parsed.error().remedy.empty());
    return;
  }
  const auto& polygons = *parsed;
  ERGOCAST_REQUIRE(!polygons.empty());
  for (const GeoPolygon& polygon : polygons) {
    ERGOCAST_REQUIRE(!polygon.rings.empty());
    for (const auto& ring : polygon.rings) {
      ERGOCAST_REQUIRE(ring.size() >= 3);
      for (const GeoPlace& place : ring) {
        ERGOCAST_REQUIRE(place.latitude_deg >= -90 && place.latitude_deg <= 90);
        ERGOCAST_REQUIRE(place.longitude_deg >= -180 && place.longitude_deg <= 180);
      }
    }
  }
}

}  // namespace ergocast::fuzz
