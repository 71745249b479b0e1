// SPDX-License-Identifier: BSD-3-Clause
// LCM's datagram is read as it was written, and no bytes lead to a read past its end.
#include "runtime/bus/lcm_datagram.h"

#include <gtest/gtest.h>

#include <array>
#include <random>
#include <string>
#include <vector>

namespace ergocast {
namespace {

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::vector<std::byte> written(std::uint32_t sequence, const std::string& channel,
                               const std::vector<std::byte>& message) {
  std::array<std::byte, kMaxLcmBytes> space;
  const std::size_t size = write_datagram(space, sequence, channel, message);
  return {space.begin(), space.begin() + static_cast<std::ptrdiff_t>(size)};
}

TEST(LcmDatagram, HasTheBytesOfLcm) {
  const std::string expected("LC02\x01\x02\x03\x04HELLO\0abc", 17);
  EXPECT_EQ(written(0x01020304, "HELLO", bytes_of("abc")), bytes_of(expected));
}

TEST(LcmDatagram, IsReadAsItWasWritten) {
  for (std::size_t name = 0; name < kMaxChannelBytes; ++name) {
    for (const std::size_t size : {std::size_t{0}, std::size_t{1}, kMaxDatagramBytes}) {
      const std::string channel(name, 'C');
      const std::vector<std::byte> message(size, std::byte{7});
      const auto datagram = written(9, channel, message);
      const auto read = parse_datagram(datagram);
      ASSERT_TRUE(read) << name;
      EXPECT_EQ(read->channel, channel);
      EXPECT_EQ(std::vector(read->message.begin(), read->message.end()), message);
    }
  }
}

TEST(LcmDatagram, IsNothingElse) {
  const auto datagram = written(9, "HELLO", bytes_of("abc"));
  for (std::size_t size = 0; size <= 13; ++size) {  // without the whole name and its zero
    EXPECT_FALSE(parse_datagram(std::span(datagram).first(size))) << size;
  }
  for (std::size_t i = 0; i < 4; ++i) {
    auto other = datagram;
    other[i] ^= std::byte{1};  // "LC03" among them
    EXPECT_FALSE(parse_datagram(other)) << i;
  }
  EXPECT_FALSE(parse_datagram(bytes_of("LC020000" + std::string(kMaxChannelBytes, 'C') + '\0')));
}

TEST(LcmDatagram, OfAnyBytesLiesWithinThem) {
  std::mt19937 dice(1);
  for (int i = 0; i < 100000; ++i) {
    std::vector<std::byte> bytes(dice() % 90);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(dice() % 4 * 85);
    const auto magic = bytes_of("LC02");
    std::copy_n(magic.begin(), std::min(magic.size(), bytes.size()), bytes.begin());
    const auto read = parse_datagram(bytes);
    if (!read) continue;
    const auto* begin = reinterpret_cast<const char*>(bytes.data());
    ASSERT_EQ(read->channel.data(), begin + kLcmHeaderBytes);
    ASSERT_LT(read->channel.size(), kMaxChannelBytes);
    ASSERT_EQ(kLcmHeaderBytes + read->channel.size() + 1 + read->message.size(), bytes.size());
  }
}

}  // namespace
}  // namespace ergocast
