// SPDX-License-Identifier: BSD-3-Clause
// Receives what another process of a study sends.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstddef>

namespace ergocast::cli {

/// Whether `size` bytes arrived before the end of the pipe or socket.
inline bool receive_whole(int from, void* to, std::size_t size) {
  auto* bytes = static_cast<std::byte*>(to);
  while (size > 0) {
    const ssize_t got = read(from, bytes, size);
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return false;
    bytes += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

}  // namespace ergocast::cli
