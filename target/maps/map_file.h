// SPDX-License-Identifier: BSD-3-Clause
// Target maps in common formats: pictures, tables of numbers, ESRI ASCII grids, occupancy maps.
//
// A map is read row by row, so that a map of 8192 × 8192 cells needs the memory of one row.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "target/rectangle.h"

namespace ergocast {

/// Limit (Files of a scenario): columns and rows of a map, and cells of a grid along an axis.
/// Beyond it: the scenario is refused.
inline constexpr int kMaxMapSide = 8192;
/// No sum of such values overflows.
/// Limit (Files of a scenario): value of a map. Beyond it: the scenario is refused.
inline constexpr double kMaxMapValue = 1e30;

/// Why a map cannot be used.
struct MapProblem {
  std::string what;    ///< with the file's name, and the line if it has lines
  std::string remedy;  ///< what to do about it
  /// Whether it is a problem of a row alone: the next one can be read.
  bool ends_row = false;
  std::vector<MapProblem> more{};  ///< other problems of the same file
};

class MapFile {
 public:
  virtual ~MapFile() = default;
  MapFile(const MapFile&) = delete;
  MapFile& operator=(const MapFile&) = delete;

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// The extent that the file states, if its kind states one.
  const std::optional<Rectangle>& extent() const { return extent_; }

  /// Reads the next row into `values`, the westernmost first: densities from 0 to kMaxMapValue, 0
  /// where there is no data. The rows come in the order of the file.
  /// @pre `values` has columns() entries, and fewer than rows() rows have been read.
  virtual std::optional<MapProblem> next_row(std::span<double> values) = 0;

 protected:
  MapFile() = default;
  int columns_ = 0, rows_ = 0;
  std::optional<Rectangle> extent_;
};

using OpenedMap = Result<std::unique_ptr<MapFile>, MapProblem>;

enum class MapKind { kPng, kPgm, kCsv, kAsciiGrid, kGeoTiff, kOccupancy };

/// Whether files of a kind state their extent.
inline bool states_extent(MapKind kind) {
  return kind == MapKind::kAsciiGrid || kind == MapKind::kGeoTiff || kind == MapKind::kOccupancy;
}

/// Why `file` cannot be opened; nothing if it can.
std::optional<MapProblem> why_unreadable(const std::filesystem::path& file);

/// The kind by the extension .png, .pgm, .csv, .asc, .tif, .tiff, .yaml or .yml, in either case;
/// nothing for any other.
std::optional<MapKind> map_kind(const std::filesystem::path& file);

/// Opens a map and reads its dimensions.
/// @pre map_kind(file), which is not kGeoTiff: open_geotiff() reads those
OpenedMap open_map(const std::filesystem::path& file);

/// 1 to kMaxMapSide columns and rows, or what is wrong with them.
std::optional<MapProblem> check_dimensions(const std::filesystem::path& file, long long columns,
                                           long long rows);

}  // namespace ergocast
