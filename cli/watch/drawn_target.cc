// SPDX-License-Identifier: BSD-3-Clause
// Reads lists of numbers, and writes them as fields of a scenario.
#include "cli/watch/drawn_target.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "text/shortest.h"

namespace ergocast::cli {
namespace {

using nlohmann::json;

template <std::size_t N>
std::optional<std::array<double, N>> numbers(const json& list) {
  if (!list.is_array() || list.size() != N) return std::nullopt;
  std::array<double, N> values{};
  for (std::size_t i = 0; i < N; ++i) {
    if (!list[i].is_number()) return std::nullopt;
    values[i] = list[i].get<double>();
    if (!std::isfinite(values[i])) return std::nullopt;
  }
  return values;
}

std::optional<DrawnTarget::Corners> corners(const json& list) {
  if (!list.is_array() || list.size() < 3) return std::nullopt;
  DrawnTarget::Corners read;
  for (const json& one : list) {
    const auto corner = numbers<2>(one);
    if (!corner) return std::nullopt;
    read.push_back(*corner);
  }
  return read;
}

}  // namespace

std::optional<DrawnTarget> DrawnTarget::parse(const json& object) {
  if (!object.is_object() || object.size() != 3) return std::nullopt;
  const auto peaks = object.find("peaks"), polygons = object.find("polygons"),
             uniform = object.find("uniform");
  if (peaks == object.end() || polygons == object.end() || uniform == object.end())
    return std::nullopt;
  if (!peaks->is_array() || !polygons->is_array() || !uniform->is_number()) return std::nullopt;
  const std::size_t parts = peaks->size() + polygons->size();
  DrawnTarget target;
  target.uniform = uniform->get<double>();
  if (parts == 0 || parts > kMostParts) return std::nullopt;
  if (!(target.uniform >= 0 && target.uniform <= kMostUniform)) return std::nullopt;
  for (const json& one : *peaks) {
    const auto peak = numbers<3>(one);
    if (!peak) return std::nullopt;
    target.peaks.push_back({(*peak)[0], (*peak)[1], (*peak)[2]});
  }
  for (const json& one : *polygons) {
    auto polygon = corners(one);
    if (!polygon) return std::nullopt;
    target.polygons.push_back(*std::move(polygon));
  }
  return target;
}

std::string DrawnTarget::text() const {
  std::string text = "target {\n";
  for (const Peak& peak : peaks)
    text += "  gaussians { mean_x_m: " + shortest(peak.x_m) + " mean_y_m: " + shortest(peak.y_m) +
            " sigma_m: " + shortest(peak.sigma_m) + " weight: 1 }\n";
  for (const Corners& polygon : polygons) {
    text += "  regions { weight: 1 polygon {";
    for (const auto& [x_m, y_m] : polygon)
      text += " vertices { x_m: " + shortest(x_m) + " y_m: " + shortest(y_m) + " }";
    text += " } }\n";
  }
  const auto parts = static_cast<double>(peaks.size() + polygons.size());
  if (uniform > 0) text += "  uniform_weight: " + shortest(parts * uniform / (1 - uniform)) + "\n";
  return text + "}\n";
}

}  // namespace ergocast::cli
