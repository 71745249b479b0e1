// SPDX-License-Identifier: BSD-3-Clause
// The way to an autopilot:
//
//   udp:HOST:PORT           sends there first, and receives what that address answers
//   udpin:[HOST:]PORT       waits there; answers the address from which datagrams come
//   tcp:HOST:PORT           connects, and again if the connection ends
//   serial:DEVICE:BAUD      8 bits, no parity; opened again if the device goes and comes
//
// A link that is down loses what is written. Nothing waits for it.
#pragma once

#include <ergocast/core/base/ids.h>
#include <ergocast/core/base/result.h>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ergocast::mavlink {

class Link {
 public:
  /// The link, or why the text names none, or what the system refuses.
  static Result<std::unique_ptr<Link>> open(std::string_view text);
  virtual ~Link() = default;

  /// To wait for; −1 while the link is down.
  virtual int fd() const = 0;
  /// Whether each read() is a whole datagram.
  virtual bool has_datagrams() const = 0;
  /// The next bytes; empty if there are none now, or if too many datagrams of others come first.
  virtual std::vector<std::byte> read(Instant now) = 0;
  /// Leaves the frame out while older ones wait to be sent.
  virtual void write(std::span<const std::byte> frame) = 0;
  /// Opens the link again, at most once a second, if it is down. An answer says that its state has
  /// changed.
  virtual std::string mend(Instant) { return ""; }
};

}  // namespace ergocast::mavlink
