// SPDX-License-Identifier: BSD-3-Clause
// The checksum of MAVLink: CRC-16/MCRF4XX, which begins at 0xFFFF and reads each byte's lowest bit
// first (polynomial x¹⁶ + x¹² + x⁵ + 1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace ergocast::mavlink {

class Checksum {
 public:
  void add(std::byte byte) {
    value_ = static_cast<std::uint16_t>(value_ ^ std::to_integer<std::uint16_t>(byte));
    for (int bit = 0; bit < 8; ++bit) {
      const bool low = (value_ & 1) != 0;
      value_ = static_cast<std::uint16_t>((value_ >> 1) ^ (low ? 0x8408 : 0));
    }
  }
  void add(std::span<const std::byte> bytes) {
    for (const std::byte byte : bytes) add(byte);
  }
  void add(std::string_view text) { add(std::as_bytes(std::span(text))); }

  std::uint16_t value() const { return value_; }

 private:
  std::uint16_t value_ = 0xFFFF;
};

}  // namespace ergocast::mavlink
