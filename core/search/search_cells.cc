// SPDX-License-Identifier: BSD-3-Clause
// Chooses cells with the sensor's radius as their side, if there are not too many.
#include "core/search/search_cells.h"

#include <algorithm>

#include "core/base/portable_math.h"
#include "core/measure/detection.h"

namespace ergocast {
namespace {

constexpr double kLeastRadiusPerSearchCell = 0.75;
/// The effort of one agent that counts in a cell. Refuting two false alarms in it takes about 10.
constexpr double kMostNats = 8, kMostNatsWithFalseAlarms = 16;

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
      ticks_per_look(ergocast::ticks_per_look(mission, cells)),
      look_bits(mission.sensor.has_false_alarms() ? 12 : 16) {
  const double share = portable::square(sensor_radius_m(mission) / radius_m);
  nats_per_look = share * mission.sensor.detections_per_s * static_cast<double>(ticks_per_look) *
                  mission.timing.dt_s;
  const double nats = reports() ? kMostNatsWithFalseAlarms : kMostNats;
  const double most = (1 << look_bits) - 1;
  most_looks = static_cast<std::uint16_t>(std::clamp(nats / nats_per_look, 1.0, most));
}

}  // namespace ergocast
