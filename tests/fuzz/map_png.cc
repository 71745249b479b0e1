// SPDX-License-Identifier: BSD-3-Clause
// A PNG. Its chunks carry checksums, at which a changed file would always fail, so they are
// corrected.
#include <zlib.h>

#include "target/maps/png_map.h"
#include "tests/fuzz/map_target.h"
#include "tests/fuzz/support/datagrams.h"

namespace ergocast::fuzz {
namespace {

constexpr std::size_t kSignatureBytes = 8;
constexpr std::size_t kChunkFrame = 12;  // length, name, checksum

std::uint32_t read32(const std::uint8_t* at) {
  return std::uint32_t{at[0]} << 24 | at[1] << 16 | at[2] << 8 | at[3];
}

void make_checksums_right(std::span<std::uint8_t> png) {
  for (std::size_t at = kSignatureBytes; at + kChunkFrame <= png.size();) {
    const std::size_t length = read32(&png[at]);
    if (length > png.size() - at - kChunkFrame) return;
    const auto sum = crc32(0, &png[at + 4], static_cast<uInt>(length + 4));
    for (std::size_t i = 0; i < 4; ++i) {
      png[at + 8 + length + i] = static_cast<std::uint8_t>(sum >> (24 - 8 * i));
    }
    at += kChunkFrame + length;
  }
}

/// A byte of the header, or any.
std::size_t mutate(std::span<std::uint8_t> space, std::size_t size, std::uint64_t seed) {
  constexpr std::size_t kHeaderEnd = kSignatureBytes + 8 + 13;
  if (size <= kHeaderEnd) return size;
  Dice dice(seed);
  const std::size_t first = kSignatureBytes + 8;
  const std::size_t end = dice.below(2) == 0 ? kHeaderEnd : size;
  std::uint8_t& byte = space[first + dice.below(end - first)];
  constexpr std::uint8_t kTelling[] = {0, 1, 2, 3, 4, 6, 8, 16, 32, 127, 255};
  byte = dice.below(2) == 0 ? kTelling[dice.below(std::size(kTelling))]
                            : static_cast<std::uint8_t>(byte ^ 1U << dice.below(8));
  return size;
}

}  // namespace

FUZZ_TARGET_WITH(map_png, &mutate) {
  std::vector<std::uint8_t> png(input.begin(), input.end());
  make_checksums_right(png);
  read_map(png, &open_png_map);
}

}  // namespace ergocast::fuzz
