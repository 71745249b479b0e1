// SPDX-License-Identifier: BSD-3-Clause
// Reads with recvmmsg into fixed buffers, and separates the kernel's two kinds of drops.
#include "runtime/bus/bus_reader.h"

#include <linux/sock_diag.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "runtime/bus/group_socket.h"

namespace ergocast {
namespace {

/// The most of a receive buffer that one of our datagrams takes. The driver decides how much; on
/// the loopback it is 2304.
constexpr std::size_t kMostBufferBytes = 4608;

}  // namespace

BusReader::BusReader(Bus bus, MessageTypes types, bool replays)
    : bus_(bus), types_(types), replays_(replays), socket_(AF_INET, SOCK_DGRAM) {
  for (std::size_t i = 0; i < kBatch; ++i) {
    parts_[i] = {space_[i].data(), space_[i].size()};
    messages_[i].msg_hdr.msg_iov = &parts_[i];
    messages_[i].msg_hdr.msg_iovlen = 1;
  }
}

Result<std::unique_ptr<BusReader>> BusReader::open(const LcmUrl& url, Bus bus, MessageTypes types,
                                                   bool replays) {
  std::unique_ptr<BusReader> reader(new BusReader(bus, types, replays));
  const auto failed = [&url, bus](const std::string& why) {
    return failure(url.of(bus) + ": " + why);
  };
  if (reader->fd() < 0) return failed(no_socket(errno));
  reader->set_receive_buffer(url);
  // The filter is set before the socket has a port, so that nothing passes it.
  reader->filtered_ = admit_only(reader->fd(), types, {}, replays);
  if (const auto problem =
          listen_to_group(reader->socket_, url.group, url.base_port + static_cast<int>(bus))) {
    return failed(*problem);
  }
  return reader;
}

void BusReader::set_receive_buffer(const LcmUrl& url) {
  const int asked = url.receive_buffer();
  setsockopt(fd(), SOL_SOCKET, SO_RCVBUF, &asked, sizeof asked);
  int granted = 0;
  socklen_t length = sizeof granted;
  getsockopt(fd(), SOL_SOCKET, SO_RCVBUF, &granted, &length);
  buffer_bytes_ = static_cast<std::uint32_t>(granted);
  // One batch never takes more than a quarter out of a full buffer.
  batch_ = std::clamp<std::size_t>(buffer_bytes_ / (4 * kMostBufferBytes), 1, kBatch);
}

std::size_t BusReader::receive() {
  const int count =
      recvmmsg(fd(), messages_.data(), static_cast<unsigned>(batch_), MSG_DONTWAIT, nullptr);
  if (count <= 0) return 0;
  // A smaller batch has emptied the buffer, which therefore was not full.
  if (static_cast<std::size_t>(count) == batch_) look_at_drops();
  return static_cast<std::size_t>(count);
}

bool BusReader::has_room_for(std::size_t datagrams) const {
  return datagrams <= buffer_bytes_ / kMostBufferBytes;
}

void BusReader::drop_repeats(std::span<const Repeated> flooded) {
  while (!admit_only(fd(), types_, flooded, replays_) && !flooded.empty()) {
    flooded = flooded.first(flooded.size() / 2);
  }
  drops_repeats_ = !flooded.empty();
}

void BusReader::look_at_drops() {
  std::array<std::uint32_t, SK_MEMINFO_VARS> memory{};
  socklen_t bytes = sizeof memory;
  if (getsockopt(fd(), SOL_SOCKET, SO_MEMINFO, memory.data(), &bytes) != 0) return;
  // The counter has 32 bits and may pass its end.
  const std::uint32_t drops = memory[SK_MEMINFO_DROPS];
  const std::uint32_t more = drops - std::exchange(drops_seen_, drops);
  const bool was_full = batch_ == 1 || memory[SK_MEMINFO_RMEM_ALLOC] >= buffer_bytes_ / 2;
  (was_full && !drops_repeats_ ? lost_ : rejected_) += more;
}

std::int64_t BusReader::lost() {
  look_at_drops();
  return lost_;
}

std::int64_t BusReader::take_rejected() {
  look_at_drops();
  return std::exchange(rejected_, 0);
}

}  // namespace ergocast
