// SPDX-License-Identifier: BSD-3-Clause
// Checks every field of a map, and writes its rows from the north, as pictures have them.
#include "bridges/ros2/map.h"

#include <array>
#include <charconv>
#include <cmath>

#include "target/maps/map_file.h"
#include "text/printable.h"
#include "text/shortest.h"

namespace ergocast::ros2 {
namespace {

// Those of target/maps/map_yaml.cc.
constexpr double kSmallestCell_m = 1e-6, kLargestCell_m = 1e6, kFarthestOrigin_m = 1e7;
/// A larger part of an orientation that is no turn about z, or another length, is refused.
constexpr double kMostTilt = 1e-3;
constexpr int kFreePercent = 25, kOccupiedPercent = 65;  // map_saver's
constexpr unsigned char kFree = 254, kOccupied = 0, kUnknown = 205, kUnknownRaw = 255;

/// A float as map_saver writes it: 0.05, not 0.05000000074505806.
std::string shortest_float(float value) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end};
}

/// What is wrong, without the topic; empty if all is well.
std::string problem_of(const MapMessage& map, const std::string& frame) {
  if (map.frame != frame)
    return "is in the frame '" + printable(map.frame.substr(0, 100)) + "', not in '" +
           printable(frame) + "': choose another topic, or say --frame";
  const double cell_m = static_cast<double>(map.resolution_m);
  if (!(cell_m >= kSmallestCell_m && cell_m <= kLargestCell_m))
    return "has the resolution " + shortest(cell_m) +
           " m, which is not from 1e-6 to 1e6: correct its publisher";
  const std::string size = std::to_string(map.width) + " × " + std::to_string(map.height);
  if (map.width < 1 || map.height < 1 || map.width > kMaxMapSide || map.height > kMaxMapSide)
    return "has " + size + " cells, and a map has 1 to " + std::to_string(kMaxMapSide) +
           " along each side: choose another resolution";
  if (map.data.size() != std::size_t{map.width} * map.height)
    return "has " + size + " cells and " + std::to_string(map.data.size()) +
           " values: correct its publisher";
  for (const double one : {map.origin_m.x(), map.origin_m.y(), map.origin_m.z()})
    if (!(std::abs(one) <= kFarthestOrigin_m))
      return "has its origin at " + shortest(one) + " m, beyond 1e7: correct its publisher";
  const Eigen::Vector4d& q = map.orientation;
  if (!(std::abs(q.norm() - 1) <= kMostTilt))
    return "has an orientation of the length " + shortest(q.norm()) +
           ", not 1: correct its publisher";
  if (!(std::hypot(q.x(), q.y()) <= kMostTilt)) return "is tilted: only a turn about z can be read";
  for (std::size_t i = 0; i < map.data.size(); ++i)
    if (map.data[i] < -1 || map.data[i] > 100)
      return "has the value " + std::to_string(map.data[i]) + " in cell (" +
             std::to_string(i % map.width) + ", " + std::to_string(i / map.width) +
             "), which is neither −1 nor from 0 to 100: correct its publisher";
  return "";
}

unsigned char pixel_of(int percent, MapMode mode) {
  if (mode == MapMode::kRaw) return percent < 0 ? kUnknownRaw : static_cast<unsigned char>(percent);
  if (percent < 0) return kUnknown;
  if (percent <= kFreePercent) return kFree;
  return percent >= kOccupiedPercent ? kOccupied : kUnknown;
}

std::string picture_of(const MapMessage& map, MapMode mode) {
  std::string text =
      "P5\n" + std::to_string(map.width) + ' ' + std::to_string(map.height) + "\n255\n";
  for (std::size_t j = map.height; j-- > 0;)
    for (const std::int8_t percent : map.data.subspan(j * map.width, map.width))
      text += static_cast<char>(pixel_of(percent, mode));
  return text;
}

}  // namespace

Result<SavedMap> save_map(const MapMessage& map, const std::string& topic, const std::string& frame,
                          const std::string& picture, MapMode mode) {
  const std::string problem = problem_of(map, frame);
  if (!problem.empty()) return failure(topic + " " + problem);
  SavedMap saved;
  saved.yaw_rad = 2 * std::atan2(map.orientation.z(), map.orientation.w());
  saved.yaw_rad = std::remainder(saved.yaw_rad, 2 * M_PI);
  if (std::abs(saved.yaw_rad) < 1e-9) saved.yaw_rad = 0;
  for (const std::int8_t percent : map.data) saved.unknown += percent < 0 ? 1 : 0;
  // A cell of the shade 205 must not be below free_thresh. Raw percentages are in or out as the
  // thresholds of trinary have it.
  const bool raw = mode == MapMode::kRaw;
  saved.yaml = "image: " + picture + "\nmode: " + (raw ? "raw" : "trinary") +
               "\nresolution: " + shortest_float(map.resolution_m) + "\norigin: [" +
               shortest(map.origin_m.x()) + ", " + shortest(map.origin_m.y()) + ", " +
               shortest(saved.yaw_rad) +
               "]\nnegate: 0\noccupied_thresh: " + (raw ? "0.649" : "0.65") +
               "\nfree_thresh: " + (raw ? "0.251" : "0.196") + "\n";
  saved.picture = picture_of(map, mode);
  return saved;
}

}  // namespace ergocast::ros2
