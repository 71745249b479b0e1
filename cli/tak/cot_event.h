// SPDX-License-Identifier: BSD-3-Clause
// An event of Cursor on Target 2.0, as clients of TAK read it. No clock, no I/O.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "target/geo/local_plane.h"

namespace ergocast::cli {

using WallTime = std::chrono::system_clock::time_point;

struct CotEvent {
  struct Track {
    double course_deg = 0;  ///< clockwise from north, 0 to 360
    double speed_mps = 0;
  };

  std::string uid, type;
  std::string how = "m-f";  ///< "m-f": a machine has fused it from sensors; "h-e": a person drew it
  GeoPlace place;
  std::string callsign, remarks;
  std::optional<Track> track{};
  std::vector<GeoPlace> outline{};  ///< of a drawn shape, without the repeated first corner
  int argb = 0;                     ///< of a point or a shape; 0: the client's own colour
  std::chrono::seconds lasts{5};    ///< after this time it is stale
};

/// The event in XML. Heights above the ellipsoid and errors are told as unknown, 9999999.
std::string cot_xml(const CotEvent& event, WallTime time);

}  // namespace ergocast::cli
