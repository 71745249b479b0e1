// SPDX-License-Identifier: BSD-3-Clause
// The pictures of occupancy maps: PGM and PNG, row by row.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>

#include "core/base/result.h"
#include "target/maps/map_file.h"

namespace ergocast {

/// A pixel by the mean of its colours.
struct Pixel {
  double shade = 0;    ///< 0 black to 1 white
  double opacity = 1;  ///< 0 transparent to 1
};

class Picture {
 public:
  virtual ~Picture() = default;
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  /// Whether the file states the opacity of pixels.
  bool has_alpha() const { return has_alpha_; }

  /// Reads the next row, from the top.
  /// @pre `pixels` has columns() entries, and fewer than rows() rows have been read.
  virtual std::optional<MapProblem> next_row(std::span<Pixel> pixels) = 0;

 protected:
  Picture() = default;
  int columns_ = 0, rows_ = 0;
  bool has_alpha_ = false;
};

using OpenedPicture = Result<std::unique_ptr<Picture>, MapProblem>;

/// Opens a PGM (P2 or P5, up to 16 bits) or PNG, whatever its name, with 1 to kMaxMapSide columns
/// and rows.
OpenedPicture open_picture(const std::filesystem::path& file);

}  // namespace ergocast
