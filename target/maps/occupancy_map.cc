// SPDX-License-Identifier: BSD-3-Clause
// Compares the shades of pixels with the thresholds, as nav2's map_io.cpp does.
#include "target/maps/occupancy_map.h"

#include <cmath>
#include <system_error>
#include <utility>

namespace ergocast {
namespace fs = std::filesystem;

bool is_occupancy_map(const fs::path& file) {
  const fs::path end = file.extension();
  return end == ".yaml" || end == ".yml";
}

OccupancyMap::OccupancyMap(MapYaml about, std::unique_ptr<Picture> picture)
    : about_(std::move(about)),
      picture_(std::move(picture)),
      pixels_(static_cast<std::size_t>(picture_->columns())) {}

Result<OccupancyMap, MapProblem> OccupancyMap::open(const fs::path& yaml) {
  auto about = read_map_yaml(yaml);
  if (!about) return failure(about.error());
  std::error_code error;
  if (!fs::exists(about->image, error))
    return failure(
        MapProblem{yaml.string() + ": its image " + about->image.string() + " is missing",
                   "copy the picture there: image counts from the folder of this file"});
  auto picture = open_picture(about->image);
  if (!picture) return failure(picture.error());
  return OccupancyMap(*std::move(about), *std::move(picture));
}

std::uint8_t OccupancyMap::cell_of(const Pixel& pixel) const {
  double shade = pixel.shade;
  // nav2 takes opacity for a fourth colour in this mode.
  if (about_.mode == OccupancyMode::kTrinary && picture_->has_alpha())
    shade = (3 * shade + pixel.opacity) / 4;
  double occupied = about_.negate ? shade : 1 - shade;
  if (about_.mode == OccupancyMode::kRaw) occupied = std::round(255 * shade) / 100;
  if (about_.mode == OccupancyMode::kScale && pixel.opacity < 1) return kUnknownCell;
  if (about_.mode == OccupancyMode::kRaw && occupied > 1) return kUnknownCell;
  if (occupied > about_.occupied_thresh) return kOccupiedCell;
  return occupied < about_.free_thresh ? kFreeCell : kUnknownCell;
}

double OccupancyMap::percent_of(const Pixel& pixel) const {
  if (about_.mode == OccupancyMode::kRaw) {
    const double value = std::round(255 * pixel.shade);
    return value > 100 ? 0 : value;
  }
  if (pixel.opacity < 1) return 0;
  const double occupied = about_.negate ? pixel.shade : 1 - pixel.shade;
  if (occupied < about_.free_thresh) return 0;
  if (occupied > about_.occupied_thresh) return 100;
  const double range = about_.occupied_thresh - about_.free_thresh;
  return range > 0 ? 100 * (occupied - about_.free_thresh) / range : 0;
}

std::optional<MapProblem> OccupancyMap::next_percents(std::span<double> values) {
  if (auto problem = picture_->next_row(pixels_)) return problem;
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = percent_of(pixels_[i]);
  return {};
}

std::optional<MapProblem> OccupancyMap::next_row(std::span<std::uint8_t> cells) {
  if (auto problem = picture_->next_row(pixels_)) return problem;
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = cell_of(pixels_[i]);
  return {};
}

}  // namespace ergocast
