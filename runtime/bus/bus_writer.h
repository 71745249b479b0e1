// SPDX-License-Identifier: BSD-3-Clause
// Sends LCM datagrams to the three buses, many with one system call.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/base/result.h"
#include "runtime/bus/lcm_datagram.h"
#include "runtime/bus/lcm_url.h"
#include "runtime/bus/socket.h"
#include "team/messages.h"

namespace ergocast {

class BusWriter {
 public:
  /// An error names its cause.
  static Result<std::unique_ptr<BusWriter>> open(const LcmUrl& url);

  /// Keeps a message until flush(); sends what it keeps when it has no more room.
  /// @pre as write_datagram()
  void add(Bus bus, std::string_view channel, std::span<const std::byte> message);

  /// Sends the kept messages in their order. Like any message on the way, one that the kernel
  /// refuses is lost.
  void flush();

 private:
  static constexpr std::size_t kBatch = 32;

  explicit BusWriter(const LcmUrl& url);

  Socket socket_;
  std::array<sockaddr_in, kBusCount> buses_{};
  std::array<std::uint32_t, kBusCount> sequences_{};
  std::size_t kept_ = 0;
  std::array<std::array<std::byte, kMaxLcmBytes>, kBatch> space_;
  std::array<iovec, kBatch> parts_{};
  std::array<mmsghdr, kBatch> messages_{};
};

}  // namespace ergocast
