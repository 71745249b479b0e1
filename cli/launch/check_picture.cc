// SPDX-License-Identifier: BSD-3-Clause
// Draws in metres; one transformation turns y up and scales.
#include "cli/launch/check_picture.h"

#include <cstdio>

namespace ergocast::cli {
namespace {

constexpr double kLongerSide_px = 1000;

void add(std::string& svg, const char* format, auto... values) {
  char text[400];
  std::snprintf(text, sizeof text, format, values...);
  svg += text;
}

/// The rings as one shape whose inner rings are holes.
void add_shape(std::string& svg, const Rings& rings, const char* paint) {
  add(svg, "<path fill-rule=\"evenodd\" %s d=\"", paint);
  for (const Ring& ring : rings) {
    for (std::size_t i = 0; i < ring.size(); ++i)
      add(svg, "%c%.7g,%.7g", i == 0 ? 'M' : 'L', ring[i].x(), ring[i].y());
    svg += "Z";
  }
  svg += "\"/>\n";
}

}  // namespace

std::string picture_of(const Scenario& scenario) {
  const Mission& mission = scenario.mission();
  const Eigen::Vector3d &low_m = mission.domain.origin_m, &size_m = mission.domain.size_m;
  const double scale = kLongerSide_px / size_m.head<2>().maxCoeff();
  const double width = scale * size_m.x(), height = scale * size_m.y();
  std::string svg;
  add(svg, "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%.0f\" height=\"%.0f\">\n", width,
      height);
  add(svg,
      "<pattern id=\"closed\" width=\"%g\" height=\"%g\" patternUnits=\"userSpaceOnUse\" "
      "patternTransform=\"rotate(45)\"><path fill=\"#fc9\" d=\"M0,0H%gV%gH0Z\"/><path "
      "fill=\"#d40\" d=\"M0,0H%gV%gH0Z\"/></pattern>\n",
      6 / scale, 6 / scale, 6 / scale, 6 / scale, 2 / scale, 6 / scale);
  add(svg, "<path fill=\"#fff\" d=\"M0,0H%gV%gH0Z\"/>\n", width, height);
  add(svg, "<g transform=\"translate(%.9g %.9g) scale(%.9g %.9g)\">\n", -scale * low_m.x(),
      height + scale * low_m.y(), scale, -scale);
  add_shape(svg, mission.walls, "fill=\"#777\"");
  for (const MapRooms& map : scenario.map_rooms()) {
    for (const Polygon& polygon : map.closed)
      add_shape(svg, rings_of(polygon), "fill=\"url(#closed)\"");
  }
  for (const Eigen::Vector3d& start_m : mission.starts_m)
    add(svg, "<circle cx=\"%.7g\" cy=\"%.7g\" r=\"%g\" fill=\"#04c\"/>\n", start_m.x(), start_m.y(),
        5 / scale);
  return svg + "</g>\n</svg>\n";
}

}  // namespace ergocast::cli
