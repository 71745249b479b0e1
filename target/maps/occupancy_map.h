// SPDX-License-Identifier: BSD-3-Clause
// Occupancy maps of robots: a description (.yaml) and a picture, as ROS's map_server and nav2 write
// and read them.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "core/base/result.h"
#include "target/contour/specks.h"
#include "target/maps/map_file.h"
#include "target/maps/map_yaml.h"
#include "target/maps/picture.h"

namespace ergocast {

/// Whether the name ends in .yaml or .yml.
bool is_occupancy_map(const std::filesystem::path& file);

/// A map that is read row by row.
class OccupancyMap {
 public:
  static Result<OccupancyMap, MapProblem> open(const std::filesystem::path& yaml);

  const MapYaml& about() const { return about_; }
  int columns() const { return picture_->columns(); }
  int rows() const { return picture_->rows(); }

  /// Reads the next row, from the north: kFreeCell, kOccupiedCell or kUnknownCell of each cell. A
  /// cell's occupancy is 1 − shade, or the shade if `negate`; in the mode raw it is a whole number
  /// of percent. A cell is free below free_thresh, occupied above occupied_thresh, else unknown. So
  /// is a pixel that is not opaque in the mode scale, and one above 100 in the mode raw.
  /// @pre `cells` has columns() entries, and fewer than rows() rows have been read.
  std::optional<MapProblem> next_row(std::span<std::uint8_t> cells);

  /// Reads the next row as a map in the mode scale or raw: the occupancy of each cell in percent, 0
  /// where it is unknown. Scale: 0 below free_thresh, 100 above occupied_thresh, and even between.
  std::optional<MapProblem> next_percents(std::span<double> values);

 private:
  OccupancyMap(MapYaml about, std::unique_ptr<Picture> picture);
  std::uint8_t cell_of(const Pixel& pixel) const;
  double percent_of(const Pixel& pixel) const;

  MapYaml about_;
  std::unique_ptr<Picture> picture_;
  std::vector<Pixel> pixels_;
};

}  // namespace ergocast
