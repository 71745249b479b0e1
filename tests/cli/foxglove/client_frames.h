// SPDX-License-Identifier: BSD-3-Clause
// Frames of a WebSocket client, and those that the server has sent, for tests.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace ergocast::test {

/// A masked frame.
inline std::string client_frame(int opcode, std::string_view payload, bool is_last = true) {
  constexpr std::string_view kMask = "\x37\xfa\x21\x3d";
  std::string bytes(1, static_cast<char>((is_last ? 0x80 : 0) | opcode));
  const int wide = payload.size() < 126 ? 0 : payload.size() < 65536 ? 2 : 8;
  bytes += static_cast<char>(0x80 | (wide == 0   ? static_cast<int>(payload.size())
                                     : wide == 2 ? 126
                                                 : 127));
  for (int i = wide - 1; i >= 0; --i) bytes += static_cast<char>(payload.size() >> (8 * i) & 0xff);
  bytes += kMask;
  for (std::size_t i = 0; i < payload.size(); ++i)
    bytes += static_cast<char>(payload[i] ^ kMask[i % 4]);
  return bytes;
}

struct ServerFrame {
  int opcode = 0;
  std::string payload;
};

/// The whole frames at the beginning of `bytes`, which are removed.
inline std::vector<ServerFrame> take_frames(std::string& bytes) {
  std::vector<ServerFrame> frames;
  for (std::size_t at = 0;;) {
    const auto byte = [&](std::size_t i) {
      return static_cast<std::size_t>(static_cast<unsigned char>(bytes[at + i]));
    };
    const std::size_t left = bytes.size() - at;
    const std::size_t wide = left < 2 ? 0 : byte(1) < 126 ? 0 : byte(1) == 126 ? 2 : 8;
    std::size_t size = left < 2 ? 0 : byte(1);
    if (left >= 2 + wide && wide > 0) size = 0;
    for (std::size_t i = 0; left >= 2 + wide && i < wide; ++i) size = size << 8 | byte(2 + i);
    if (left < 2 + wide || left < 2 + wide + size) {
      bytes.erase(0, at);
      return frames;
    }
    frames.push_back({static_cast<int>(byte(0) & 0x0f), bytes.substr(at + 2 + wide, size)});
    at += 2 + wide + size;
  }
}

}  // namespace ergocast::test
