// SPDX-License-Identifier: BSD-3-Clause
// Receives the datagrams of one bus: one socket, read many datagrams at a time. No thread and no
// queue but the kernel's stand between the socket and the event loop.
#pragma once

#include <sys/socket.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "core/base/result.h"
#include "runtime/bus/datagram_filter.h"
#include "runtime/bus/lcm_datagram.h"
#include "runtime/bus/lcm_url.h"
#include "runtime/bus/socket.h"
#include "team/messages.h"
#include "team/subscriptions.h"

namespace ergocast {

class BusReader {
 public:
  /// Opens the socket. The kernel passes on the channels of `types` only, with `replays` also those
  /// of `ergocast replay`. An error names its cause.
  static Result<std::unique_ptr<BusReader>> open(const LcmUrl& url, Bus bus, MessageTypes types,
                                                 bool replays = false);

  int fd() const { return socket_.fd(); }
  Bus bus() const { return bus_; }
  /// Whether the buffer holds so many of our datagrams, so that none is lost before it is read.
  bool has_room_for(std::size_t datagrams) const;
  /// False if the kernel has no socket filters: then everything that is sent to the port arrives.
  bool filtered() const { return filtered_; }

  /// Reads waiting datagrams, at most batch(); never waits. Returns how many. Any bytes may come.
  std::size_t receive();
  std::size_t batch() const { return batch_; }
  /// @pre i < what receive() returned; valid until the next call. A datagram longer than ours is
  /// cut to a length that is still longer than ours.
  std::span<const std::byte> datagram(std::size_t i) const {
    return {space_[i].data(), messages_[i].msg_len};
  }

  /// From now on the kernel drops most messages of these incarnations up to these sequences. It
  /// does so for as many incarnations as it has room for.
  void drop_repeats(std::span<const Repeated> flooded);

  /// Datagrams that were lost for want of buffer space.
  ///
  /// The kernel has one counter for these and for those that the filter rejected. Only receive()
  /// empties a buffer. So none was lost since the last batch if the buffer is less than half full
  /// after the next one. What the kernel has counted since the last look counts as lost only if the
  /// buffer is fuller. While repeats are dropped, nothing counts as lost.
  std::int64_t lost();
  /// Datagrams that the filter rejected since the last call.
  std::int64_t take_rejected();

 private:
  static constexpr std::size_t kBatch = 32;
  using Space = std::array<std::byte, kMaxLcmBytes + 1>;

  BusReader(Bus bus, MessageTypes types, bool replays);
  void set_receive_buffer(const LcmUrl& url);
  void look_at_drops();

  Bus bus_;
  MessageTypes types_;
  bool replays_;
  Socket socket_;
  bool filtered_ = false, drops_repeats_ = false;
  std::size_t batch_ = kBatch;
  std::uint32_t buffer_bytes_ = 0;  // of the socket, as the kernel counts them
  std::uint32_t drops_seen_ = 0;    // the kernel's counter at the last look
  std::int64_t lost_ = 0, rejected_ = 0;
  std::array<Space, kBatch> space_;
  std::array<iovec, kBatch> parts_{};
  std::array<mmsghdr, kBatch> messages_{};
};

}  // namespace ergocast
