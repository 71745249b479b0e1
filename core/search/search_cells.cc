// SPDX-License-Identifier: BSD-3-Clause
// Chooses cells with the sensor's radius as their side, if there are not too many.
#include "core/search/search_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/measure/detection.h"

namespace ergocast {
namespace {

constexpr double kLeastRadiusPerSearchCell = 0.75;
constexpr double kMostNats = 8;

double side_m(const Mission& mission) {
  return std::max(sensor_radius_m(mission),
                  mission.domain.size_m.maxCoeff() / kMaxSearchCellsPerSide);
}

int tiles(int cells) { return (cells + kTileSide - 1) / kTileSide; }

}  // namespace

SearchCells::SearchCells(const Mission& mission)
    : cells(mission.domain, side_m(mission)),
      tile_rows(tiles(cells.count.y())),
      tile_columns(tiles(cells.count.x())),
      radius_m(std::max(sensor_radius_m(mission),
                        kLeastRadiusPerSearchCell * cells.size_m.head<2>().maxCoeff())),
      ticks_per_look(ergocast::ticks_per_look(mission, cells)) {
  const double share = std::pow(sensor_radius_m(mission) / radius_m, 2);
  nats_per_look = share * mission.sensor.detections_per_s * static_cast<double>(ticks_per_look) *
                  mission.timing.dt_s;
  constexpr double kMost = std::numeric_limits<std::uint16_t>::max();
  most_looks = static_cast<std::uint16_t>(std::clamp(kMostNats / nats_per_look, 1.0, kMost));
}

}  // namespace ergocast
