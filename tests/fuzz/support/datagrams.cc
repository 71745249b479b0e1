// SPDX-License-Identifier: BSD-3-Clause
// Replaces numbers at the places of fields by extreme ones, and computes the tag again.
#include "tests/fuzz/support/datagrams.h"

#include <xxhash.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>

namespace ergocast::fuzz {
namespace {

constexpr std::size_t kTagOffset = 44, kTagBytes = 16;

constexpr std::int64_t kWhole[] = {0,
                                   1,
                                   -1,
                                   2,
                                   -2,
                                   -3,
                                   -4,
                                   -5,
                                   3,
                                   10,
                                   16,
                                   40,
                                   63,
                                   64,
                                   127,
                                   128,
                                   255,
                                   512,
                                   1024,
                                   65535,
                                   100000000,
                                   std::int64_t{1} << 31,
                                   std::int64_t{1} << 48,
                                   (std::int64_t{1} << 48) + 1,
                                   std::numeric_limits<std::int32_t>::max(),
                                   std::numeric_limits<std::int32_t>::min(),
                                   std::numeric_limits<std::int64_t>::max(),
                                   std::numeric_limits<std::int64_t>::min()};
constexpr double kReal[] = {0,
                            -0.0,
                            1,
                            -1,
                            0.1,
                            1e-300,
                            5e-324,
                            1e9,
                            1e18,
                            -1e18,
                            1e300,
                            -1e300,
                            std::numeric_limits<double>::max(),
                            std::numeric_limits<double>::infinity(),
                            -std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()};

/// Big-endian numbers of `width` bytes, as LCM has them.
std::uint64_t read(std::span<const std::uint8_t> at) {
  std::uint64_t value = 0;
  for (const std::uint8_t byte : at) value = value << 8 | byte;
  return value;
}
void write(std::span<std::uint8_t> at, std::uint64_t value) {
  for (std::size_t i = at.size(); i-- > 0; value >>= 8) at[i] = static_cast<std::uint8_t>(value);
}

/// Another number for the one at `field`.
std::uint64_t instead_of(std::span<const std::uint8_t> field, Dice& dice) {
  switch (dice.below(4)) {
    case 0:
      return static_cast<std::uint64_t>(kWhole[dice.below(std::size(kWhole))]);
    case 1:
      return std::bit_cast<std::uint64_t>(kReal[dice.below(std::size(kReal))]);
    case 2:
      return read(field) + dice.below(33) - 16;
    default:
      return dice.next();
  }
}

}  // namespace

std::uint64_t Dice::next() {  // splitmix64
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
  z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
  z = (z ^ z >> 27) * 0x94d049bb133111eb;
  return z ^ z >> 31;
}

void retag(std::span<std::uint8_t> datagram) {
  const auto tag = datagram.subspan(kTagOffset, kTagBytes);
  std::fill(tag.begin(), tag.end(), std::uint8_t{0});
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, XXH3_128bits(datagram.data(), datagram.size()));
  std::memcpy(tag.data(), canonical.digest, kTagBytes);
}

std::size_t mutate_datagram(std::span<std::uint8_t> space, std::size_t size, Dice& dice) {
  if (size == 0) return 0;
  const auto what = dice.below(12);
  if (what == 0) return 1 + dice.below(size);  // cut off
  if (what == 1) {                             // longer
    const std::size_t longer = std::min(space.size(), size + 1 + dice.below(64));
    for (std::size_t i = size; i < longer; ++i) space[i] = static_cast<std::uint8_t>(dice.next());
    return longer;
  }
  if (what == 2) {  // a bit
    space[dice.below(size)] ^= static_cast<std::uint8_t>(1U << dice.below(8));
    return size;
  }
  if (what == 3) {  // a stretch copied to elsewhere in the same datagram
    const std::size_t length = 1 + dice.below(std::min<std::size_t>(size, 64));
    std::memmove(&space[dice.below(size - length + 1)], &space[dice.below(size - length + 1)],
                 length);
    return size;
  }
  // A field: one of the header, or any width anywhere after it.
  constexpr std::size_t kFields[][2] = {{8, 8}, {16, 4}, {20, 8}, {28, 8}, {36, 8}};
  constexpr std::size_t kWidths[] = {1, 4, 8, 8};
  std::size_t offset = 0, width = 1;
  if (what < 6 || size <= kHeaderBytes) {
    const auto& field = kFields[dice.below(std::size(kFields))];
    offset = field[0], width = field[1];
  } else {
    width = kWidths[dice.below(std::size(kWidths))];
    offset = kHeaderBytes + dice.below(size - kHeaderBytes);
  }
  if (offset + width > size) return size;
  const auto field = space.subspan(offset, width);
  write(field, instead_of(field, dice));
  return size;
}

}  // namespace ergocast::fuzz
