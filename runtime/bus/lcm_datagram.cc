// SPDX-License-Identifier: BSD-3-Clause
// Reads and writes the header of LCM's datagrams; numbers are big-endian.
#include "runtime/bus/lcm_datagram.h"

#include <algorithm>

#include "core/base/require.h"

namespace ergocast {
namespace {

constexpr std::size_t kNumberBytes = 4;

std::uint32_t load_big_endian(std::span<const std::byte> bytes) {
  std::uint32_t number = 0;
  for (const std::byte byte : bytes.first(kNumberBytes)) {
    number = number << 8 | std::to_integer<std::uint32_t>(byte);
  }
  return number;
}

void store_big_endian(std::byte* out, std::uint32_t number) {
  for (std::size_t i = 0; i < kNumberBytes; ++i) {
    out[i] = static_cast<std::byte>(number >> (24 - 8 * i));
  }
}

}  // namespace

std::optional<LcmDatagram> parse_datagram(std::span<const std::byte> bytes) {
  if (bytes.size() <= kLcmHeaderBytes || load_big_endian(bytes) != kLcmMagic) return std::nullopt;
  const auto rest = bytes.subspan(kLcmHeaderBytes);
  const auto name = rest.first(std::min(rest.size(), kMaxChannelBytes));
  const auto end = std::find(name.begin(), name.end(), std::byte{0});
  if (end == name.end()) return std::nullopt;
  const auto length = static_cast<std::size_t>(end - name.begin());
  return LcmDatagram{{reinterpret_cast<const char*>(name.data()), length},
                     rest.subspan(length + 1)};
}

std::size_t write_datagram(std::span<std::byte, kMaxLcmBytes> out, std::uint32_t sequence,
                           std::string_view channel, std::span<const std::byte> message) {
  ERGOCAST_REQUIRE(channel.size() < kMaxChannelBytes);
  ERGOCAST_REQUIRE(message.size() <= kMaxDatagramBytes);
  store_big_endian(out.data(), kLcmMagic);
  store_big_endian(out.data() + kNumberBytes, sequence);
  const auto name = std::as_bytes(std::span(channel));
  auto at = std::copy(name.begin(), name.end(), out.begin() + kLcmHeaderBytes);
  *at++ = std::byte{0};
  at = std::copy(message.begin(), message.end(), at);
  return static_cast<std::size_t>(at - out.begin());
}

}  // namespace ergocast
