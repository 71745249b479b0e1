// SPDX-License-Identifier: BSD-3-Clause
// PNG files for tests, written row by row.
#pragma once

#include <png.h>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <vector>

namespace ergocast::test {

struct PngKind {
  int bits = 8;
  int color = PNG_COLOR_TYPE_GRAY;
  int interlace = PNG_INTERLACE_NONE;
};

/// `sample(column, row, channel)` of every pixel, row 0 at the top.
inline void write_png(const std::filesystem::path& file, int columns, int rows, PngKind kind,
                      const std::function<int(int, int, int)>& sample) {
  std::FILE* stream = std::fopen(file.c_str(), "wb");
  if (stream == nullptr) throw std::runtime_error("cannot write " + file.string());
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, stream);
  png_set_compression_level(png, 1);
  png_set_IHDR(png, info, static_cast<png_uint_32>(columns), static_cast<png_uint_32>(rows),
               kind.bits, kind.color, kind.interlace, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  if (kind.color == PNG_COLOR_TYPE_PALETTE) {
    const png_color palette[2] = {{0, 0, 0}, {255, 255, 255}};
    png_set_PLTE(png, info, palette, 2);
  }
  png_write_info(png, info);
  const int channels = png_get_channels(png, info);
  std::vector<png_byte> line(png_get_rowbytes(png, info) + 1);
  for (int pass = png_set_interlace_handling(png); pass > 0; --pass) {
    for (int row = 0; row < rows; ++row) {
      std::size_t at = 0;
      for (int column = 0; column < columns; ++column) {
        for (int channel = 0; channel < channels; ++channel) {
          const int value = sample(column, row, channel);
          if (kind.bits == 16) line[at++] = static_cast<png_byte>(value >> 8);
          if (kind.bits >= 8) line[at++] = static_cast<png_byte>(value);
        }
      }
      png_write_row(png, line.data());
    }
  }
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  std::fclose(stream);
}

}  // namespace ergocast::test
