// SPDX-License-Identifier: BSD-3-Clause
// Writes PNG by hand with stored blocks, because small pictures are not worth compressing.
#include "report/raster.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>

#include "report/base64.h"

namespace ergocast {
namespace {

ColorScale blend(std::span<const Rgb> anchors) {
  ColorScale scale;
  for (std::size_t i = 0; i < scale.size(); ++i) {
    const double at = static_cast<double>(i) / 255 * static_cast<double>(anchors.size() - 1);
    const std::size_t low = std::min(static_cast<std::size_t>(at), anchors.size() - 2);
    const double share = at - static_cast<double>(low);
    const auto mix = [share](std::uint8_t a, std::uint8_t b) {
      return static_cast<std::uint8_t>(std::lround(a + share * (b - a)));
    };
    const Rgb &a = anchors[low], &b = anchors[low + 1];
    scale[i] = {mix(a.red, b.red), mix(a.green, b.green), mix(a.blue, b.blue)};
  }
  return scale;
}

// PNG requires zlib data. Deflate allows uncompressed blocks, which need no library.

void append_big_endian(std::string& out, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xff);
}

std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = 0xffffffff;
  for (const char byte : bytes) {
    crc ^= static_cast<std::uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
  }
  return ~crc;
}

std::uint32_t adler32(std::string_view bytes) {
  std::uint32_t a = 1, b = 0;
  for (const char byte : bytes) {
    a = (a + static_cast<std::uint8_t>(byte)) % 65521;
    b = (b + a) % 65521;
  }
  return b << 16 | a;
}

std::string zlib_stored(std::string_view bytes) {
  constexpr std::size_t kLongestBlock = 65535;
  std::string out = "\x78\x01";
  const std::uint32_t checksum = adler32(bytes);
  do {
    const std::size_t length = std::min(bytes.size(), kLongestBlock);
    out += length == bytes.size() ? '\1' : '\0';  // whether it is the last block
    for (const std::size_t number : {length, ~length}) {
      out += static_cast<char>(number & 0xff);
      out += static_cast<char>(number >> 8 & 0xff);
    }
    out += bytes.substr(0, length);
    bytes.remove_prefix(length);
  } while (!bytes.empty());
  append_big_endian(out, checksum);
  return out;
}

void append_chunk(std::string& png, const std::string& type, const std::string& content) {
  append_big_endian(png, static_cast<std::uint32_t>(content.size()));
  png += type + content;
  append_big_endian(png, crc32(type + content));
}

/// One byte a pixel, lines from the top, each after a 0: "no filter".
std::string scan_lines(const Field& field) {
  std::string lines;
  for (Eigen::Index j = field.cols(); j-- > 0;) {
    lines += '\0';
    for (Eigen::Index i = 0; i < field.rows(); ++i) {
      const double value = field(i, j) > 0 ? std::min(field(i, j), 1.0) : 0;
      lines += static_cast<char>(std::lround(value * 255));
    }
  }
  return lines;
}

}  // namespace

const ColorScale& viridis() {
  static const Rgb kAnchors[] = {{0x44, 0x01, 0x54}, {0x48, 0x28, 0x78}, {0x3e, 0x49, 0x89},
                                 {0x31, 0x68, 0x8e}, {0x26, 0x82, 0x8e}, {0x1f, 0x9e, 0x89},
                                 {0x35, 0xb7, 0x79}, {0x6e, 0xce, 0x58}, {0xb5, 0xde, 0x2b},
                                 {0xfd, 0xe7, 0x25}};
  static const ColorScale kScale = blend(kAnchors);
  return kScale;
}

const ColorScale& pencil() {
  static const Rgb kAnchors[] = {{0xff, 0xff, 0xff}, {0xd9, 0xdc, 0xe1}, {0x9a, 0xa0, 0xaa}};
  static const ColorScale kScale = blend(kAnchors);
  return kScale;
}

std::string png_data_uri(const Field& field, const ColorScale& colors) {
  std::string header, palette;
  append_big_endian(header, static_cast<std::uint32_t>(field.rows()));
  append_big_endian(header, static_cast<std::uint32_t>(field.cols()));
  header += std::string("\x08\x03\x00\x00\x00", 5);  // 8 bits a pixel, palette, plain
  for (const Rgb& color : colors) {
    for (const std::uint8_t part : {color.red, color.green, color.blue}) {
      palette += static_cast<char>(part);
    }
  }
  std::string png = "\x89PNG\r\n\x1a\n";
  append_chunk(png, "IHDR", header);
  append_chunk(png, "PLTE", palette);
  append_chunk(png, "IDAT", zlib_stored(scan_lines(field)));
  append_chunk(png, "IEND", "");
  return "data:image/png;base64," + base64(png);
}

}  // namespace ergocast
