// SPDX-License-Identifier: BSD-3-Clause
// What the readers of polygons on the earth guarantee.
#pragma once

#include <vector>

#include "core/base/result.h"
#include "target/geo/geo_polygon.h"
#include "target/geo/polygon_file.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

/// Each problem has words and a remedy; there are as many as the limit allows, and one more that
/// says so.
inline void require_words(const PolygonFileProblem& problem) {
  ERGOCAST_REQUIRE(problem.more.size() <= kMostFileProblems);
  ERGOCAST_REQUIRE(!problem.what.empty() && !problem.remedy.empty());
  for (const PolygonFileProblem& other : problem.more) {
    ERGOCAST_REQUIRE(!other.what.empty() && !other.remedy.empty() && other.more.empty());
  }
}

inline void require_places(const Result<std::vector<GeoPolygon>, PolygonFileProblem>& parsed) {
  if (!parsed) return require_words(parsed.error());
  ERGOCAST_REQUIRE(!parsed->empty());
  for (const GeoPolygon& polygon : *parsed) {
    ERGOCAST_REQUIRE(!polygon.rings.empty() || !polygon.member.empty());
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
