// SPDX-License-Identifier: BSD-3-Clause
// An SVG drawing: refused with a problem, left to be painted, or rings of finite corners.
#include "target/geo/svg.h"

#include "tests/fuzz/geo_target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(svg) {
  const auto parsed = parse_svg(text_of(input));
  if (!parsed) return require_words(parsed.error());
  const auto& drawing = *parsed;
  ERGOCAST_REQUIRE(drawing.size.minCoeff() > 0 && !drawing.to_paint.empty());
  ERGOCAST_REQUIRE(drawing.shapes.empty() == !drawing.paint_because.empty());
  for (const DrawnShape& shape : drawing.shapes) {
    ERGOCAST_REQUIRE(!shape.rings.empty());
    for (const auto& ring : shape.rings) {
      ERGOCAST_REQUIRE(ring.size() >= 3 && ring.front() != ring.back());
      for (const Eigen::Vector2d& corner : ring) ERGOCAST_REQUIRE(corner.allFinite());
    }
  }
}

}  // namespace ergocast::fuzz
