// SPDX-License-Identifier: BSD-3-Clause
// Reads the numbers of a zone, and writes them as the fields of a polygon.
#include "cli/watch/drawn_zone.h"

#include <nlohmann/json.hpp>

#include "cli/watch/drawn_numbers.h"
#include "text/shortest.h"

namespace ergocast::cli {

std::optional<DrawnZone> DrawnZone::parse(const nlohmann::json& object) {
  if (!object.is_object()) return std::nullopt;
  const auto polygon = object.find("corners_m"), lasts = object.find("lasts_s"),
             heights = object.find("heights_m");
  if (polygon == object.end() || lasts == object.end()) return std::nullopt;
  if (object.size() != (heights == object.end() ? 2U : 3U)) return std::nullopt;
  auto corners = drawn_corners(*polygon);
  if (!corners || !lasts->is_number()) return std::nullopt;
  DrawnZone zone;
  zone.corners_m = *std::move(corners);
  zone.lasts_s = lasts->get<double>();
  if (!(zone.lasts_s > 0 && std::isfinite(zone.lasts_s))) return std::nullopt;
  if (heights == object.end()) return zone;
  zone.heights_m = drawn_numbers<2>(*heights);
  if (!zone.heights_m) return std::nullopt;
  return zone;
}

std::string DrawnZone::text() const {
  std::string text;
  for (const auto& [x_m, y_m] : corners_m)
    text += "vertices { x_m: " + shortest(x_m) + " y_m: " + shortest(y_m) + " }\n";
  if (heights_m)
    text +=
        "low_z_m: " + shortest((*heights_m)[0]) + "\nhigh_z_m: " + shortest((*heights_m)[1]) + "\n";
  return text;
}

std::string DrawnZone::duration() const { return shortest(lasts_s) + "s"; }

}  // namespace ergocast::cli
