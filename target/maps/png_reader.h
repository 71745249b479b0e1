// SPDX-License-Identifier: BSD-3-Clause
// Reads the rows of a PNG with libpng.
#pragma once

#include <png.h>

#include <filesystem>
#include <optional>
#include <vector>

#include "target/maps/map_file.h"
#include "text/input_file.h"

namespace ergocast {

/// libpng reports errors by longjmp, which runs no destructors: the functions that call setjmp hold
/// only numbers and pointers.
class PngReader {
 public:
  explicit PngReader(const std::filesystem::path& file);
  ~PngReader();
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  /// Reads the header.
  std::optional<MapProblem> open();
  int color_type() const { return png_get_color_type(png_, info_); }
  int bit_depth() const { return png_get_bit_depth(png_, info_); }
  bool interlaced() const { return png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE; }
  bool has_alpha() const;
  unsigned columns() const { return png_get_image_width(png_, info_); }
  unsigned rows() const { return png_get_image_height(png_, info_); }

  enum class As {
    kStored,     ///< a transparent grey value becomes an alpha channel
    kWithAlpha,  ///< grey or three colours of 8 or 16 bits, and an alpha channel
  };
  /// Prepares the rows. @pre open(), not interlaced
  std::optional<MapProblem> begin(As as);
  /// Reads one more row.
  std::optional<MapProblem> next();

  /// @pre begin()
  bool wide() const { return wide_; }
  std::size_t channels() const { return channels_; }
  /// A sample of the row, from 0 to 255, or 65535 if wide(). PNG stores the high byte first.
  double sample(std::size_t i) const {
    return wide_ ? 256.0 * line_[2 * i] + line_[2 * i + 1] : line_[i];
  }

 private:
  static void on_error(png_structp png, png_const_charp message);
  static void on_warning(png_structp, png_const_charp) {}
  bool has_signature();
  bool read_header();
  bool begin_rows(As as);
  bool read_line(bool last);
  MapProblem damaged() const;

  std::filesystem::path file_;
  StdioFile stream_;
  png_structp png_;
  png_infop info_;
  std::vector<png_byte> line_;
  bool wide_ = false;
  std::size_t channels_ = 1;
  unsigned read_ = 0;
  char error_[128] = "";
};

}  // namespace ergocast
