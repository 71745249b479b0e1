// SPDX-License-Identifier: BSD-3-Clause
// A polygon on the earth, as the readers of geodata return it.
#pragma once

#include <string>
#include <vector>

#include "target/geo/local_plane.h"

namespace ergocast {

/// The outline, then the holes; without the repeated last position.
struct GeoPolygon {
  std::string member;                        ///< "features[2].geometry"
  std::vector<std::vector<GeoPlace>> rings;  ///< none for a feature of GeoJSON without a place
};

}  // namespace ergocast
