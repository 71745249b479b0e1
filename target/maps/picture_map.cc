// SPDX-License-Identifier: BSD-3-Clause
// Takes the shades of a picture, or what they mean by the map's description.
#include "target/maps/picture_map.h"

#include <utility>
#include <vector>

#include "target/maps/occupancy_map.h"
#include "target/maps/picture.h"

namespace ergocast {
namespace {

namespace fs = std::filesystem;

class PgmMap : public MapFile {
 public:
  explicit PgmMap(std::unique_ptr<Picture> picture)
      : picture_(std::move(picture)), pixels_(static_cast<std::size_t>(picture_->columns())) {
    columns_ = picture_->columns();
    rows_ = picture_->rows();
  }

  std::optional<MapProblem> next_row(std::span<double> values) override {
    if (auto problem = picture_->next_row(pixels_)) return problem;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = 255 * pixels_[i].shade;
    return {};
  }

 private:
  std::unique_ptr<Picture> picture_;
  std::vector<Pixel> pixels_;
};

class OccupancyTarget : public MapFile {
 public:
  explicit OccupancyTarget(OccupancyMap map) : map_(std::move(map)) {
    columns_ = map_.columns();
    rows_ = map_.rows();
    const double side_m = map_.about().resolution_m;
    extent_ = Rectangle{map_.about().origin_m, side_m * Eigen::Vector2d(columns_, rows_)};
  }

  std::optional<MapProblem> next_row(std::span<double> values) override {
    if (map_.about().mode != OccupancyMode::kTrinary) return map_.next_percents(values);
    std::vector<std::uint8_t> cells(values.size());
    if (auto problem = map_.next_row(cells)) return problem;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = cells[i] == kFreeCell ? 1 : 0;
    return {};
  }

 private:
  OccupancyMap map_;
};

}  // namespace

OpenedMap open_pgm_map(const fs::path& file) {
  auto picture = open_picture(file);
  if (!picture) return failure(picture.error());
  return std::make_unique<PgmMap>(*std::move(picture));
}

OpenedMap open_occupancy_target(const fs::path& yaml) {
  auto map = OccupancyMap::open(yaml);
  if (!map) return failure(map.error());
  if (map->about().yaw_rad != 0)
    return failure(
        MapProblem{yaml.string() + " lies turned by its yaw, and a target map cannot",
                   "write yaw 0 and turn the picture, or only its walls: world { walls { "
                   "file: … } } with uniform_weight"});
  return std::make_unique<OccupancyTarget>(*std::move(map));
}

}  // namespace ergocast
