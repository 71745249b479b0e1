// SPDX-License-Identifier: BSD-3-Clause
// Reads lists of numbers, and writes them as fields of a scenario.
#include "cli/watch/drawn_target.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "cli/watch/drawn_numbers.h"
#include "text/shortest.h"

namespace ergocast::cli {
namespace {

using nlohmann::json;

/// A peak in a plane, [x_m, y_m, sigma_m], or in a box, [x_m, y_m, z_m, sigma_m].
std::optional<DrawnTarget::Peak> peak_of(const json& list, bool in_box) {
  if (in_box) {
    const auto peak = drawn_numbers<4>(list);
    if (!peak) return std::nullopt;
    return DrawnTarget::Peak{(*peak)[0], (*peak)[1], (*peak)[3], (*peak)[2]};
  }
  const auto peak = drawn_numbers<3>(list);
  if (!peak) return std::nullopt;
  return DrawnTarget::Peak{(*peak)[0], (*peak)[1], (*peak)[2], {}};
}

/// Low and high of each polygon.
std::optional<std::vector<std::array<double, 2>>> heights_of(const json& list) {
  if (!list.is_array()) return std::nullopt;
  std::vector<std::array<double, 2>> read;
  for (const json& one : list) {
    const auto heights = drawn_numbers<2>(one);
    if (!heights) return std::nullopt;
    read.push_back(*heights);
  }
  return read;
}

}  // namespace

std::optional<DrawnTarget> DrawnTarget::parse(const json& object) {
  if (!object.is_object()) return std::nullopt;
  const auto peaks = object.find("peaks"), polygons = object.find("polygons"),
             uniform = object.find("uniform"), heights = object.find("heights_m");
  const bool in_box = heights != object.end();
  if (object.size() != (in_box ? 4U : 3U)) return std::nullopt;
  if (peaks == object.end() || polygons == object.end() || uniform == object.end())
    return std::nullopt;
  if (!peaks->is_array() || !polygons->is_array() || !uniform->is_number()) return std::nullopt;
  const std::size_t parts = peaks->size() + polygons->size();
  DrawnTarget target;
  target.uniform = uniform->get<double>();
  if (parts == 0 || parts > kMostParts) return std::nullopt;
  if (!(target.uniform >= 0 && target.uniform <= kMostUniform)) return std::nullopt;
  for (const json& one : *peaks) {
    const auto peak = peak_of(one, in_box);
    if (!peak) return std::nullopt;
    target.peaks.push_back(*peak);
  }
  for (const json& one : *polygons) {
    auto polygon = drawn_corners(one);
    if (!polygon) return std::nullopt;
    target.polygons.push_back(*std::move(polygon));
  }
  if (!in_box) return target;
  auto read = heights_of(*heights);
  if (!read || read->size() != target.polygons.size()) return std::nullopt;
  target.heights_m = *std::move(read);
  return target;
}

std::string DrawnTarget::text() const {
  std::string text = "target {\n";
  for (const Peak& peak : peaks)
    text += "  gaussians { mean_x_m: " + shortest(peak.x_m) + " mean_y_m: " + shortest(peak.y_m) +
            (peak.z_m ? " mean_z_m: " + shortest(*peak.z_m) : "") +
            " sigma_m: " + shortest(peak.sigma_m) + " weight: 1 }\n";
  for (std::size_t i = 0; i < polygons.size(); ++i) {
    text += "  regions { weight: 1 polygon {";
    for (const auto& [x_m, y_m] : polygons[i])
      text += " vertices { x_m: " + shortest(x_m) + " y_m: " + shortest(y_m) + " }";
    if (!heights_m.empty())
      text += " low_z_m: " + shortest(heights_m[i][0]) + " high_z_m: " + shortest(heights_m[i][1]);
    text += " } }\n";
  }
  const auto parts = static_cast<double>(peaks.size() + polygons.size());
  if (uniform > 0) text += "  uniform_weight: " + shortest(parts * uniform / (1 - uniform)) + "\n";
  return text + "}\n";
}

}  // namespace ergocast::cli
