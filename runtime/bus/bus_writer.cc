// SPDX-License-Identifier: BSD-3-Clause
// One socket for all buses; sendmmsg takes an address for each datagram.
#include "runtime/bus/bus_writer.h"

#include <cerrno>

namespace ergocast {

BusWriter::BusWriter(const LcmUrl& url) : socket_(AF_INET, SOCK_DGRAM) {
  for (int bus = 0; bus < kBusCount; ++bus) {
    buses_[static_cast<std::size_t>(bus)] = address_of(url.group, url.base_port + bus);
  }
  for (std::size_t i = 0; i < kBatch; ++i) {
    messages_[i].msg_hdr.msg_namelen = sizeof(sockaddr_in);
    messages_[i].msg_hdr.msg_iov = &parts_[i];
    messages_[i].msg_hdr.msg_iovlen = 1;
  }
  // The processes of one host receive each other's messages, and each receives its own.
  const unsigned char ttl = static_cast<unsigned char>(url.ttl), loop = 1;
  setsockopt(socket_.fd(), IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  setsockopt(socket_.fd(), IPPROTO_IP, IP_MULTICAST_LOOP, &loop, sizeof loop);
}

Result<std::unique_ptr<BusWriter>> BusWriter::open(const LcmUrl& url) {
  std::unique_ptr<BusWriter> writer(new BusWriter(url));
  if (writer->socket_.fd() < 0) return failure(url.base() + ": " + no_socket(errno));
  return writer;
}

void BusWriter::add(Bus bus, std::string_view channel, std::span<const std::byte> message) {
  if (kept_ == kBatch) flush();
  const auto at = static_cast<std::size_t>(bus);
  messages_[kept_].msg_hdr.msg_name = &buses_[at];
  parts_[kept_] = {space_[kept_].data(),
                   write_datagram(space_[kept_], sequences_[at]++, channel, message)};
  ++kept_;
}

void BusWriter::flush() {
  for (std::size_t sent = 0; sent < kept_;) {
    const int count =
        sendmmsg(socket_.fd(), &messages_[sent], static_cast<unsigned>(kept_ - sent), 0);
    sent += count > 0 ? static_cast<std::size_t>(count) : 1;  // skips a refused message
  }
  kept_ = 0;
}

}  // namespace ergocast
