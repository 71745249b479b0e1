#include "runtime/group_membership.h"

#include <arpa/inet.h>

#include "runtime/multicast_route.h"
#include "runtime/socket.h"

namespace ergocast {
namespace {

constexpr int kMaxDescriptors = 256;

/// The UDP port a descriptor is bound to; 0 if it is none, or no such socket.
int bound_port(int fd) {
  sockaddr_in address{};
  socklen_t length = sizeof address;
  int type = 0;
  socklen_t type_length = sizeof type;
  if (getsockopt(fd, SOL_SOCKET, SO_TYPE, &type, &type_length) != 0 || type != SOCK_DGRAM) return 0;
  if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &length) != 0) return 0;
  return address.sin_family == AF_INET ? ntohs(address.sin_port) : 0;
}

}  // namespace

GroupMembership::GroupMembership(const LcmUrl& url)
    : group_(address_of(url.group, 0).sin_addr), interface_(interface_towards(group_)) {
  for (int fd = 0; fd < kMaxDescriptors; ++fd) {
    const int port = bound_port(fd);
    if (port >= url.base_port && port < url.base_port + kBusCount) sockets_.push_back(fd);
  }
}

bool GroupMembership::renew() {
  const unsigned leads_there = interface_towards(group_);
  if (leads_there == 0) return false;
  const ip_mreqn now{group_, {}, static_cast<int>(leads_there)};
  const ip_mreqn former{group_, {}, static_cast<int>(interface_)};
  bool renewed = false;
  for (const int fd : sockets_) {
    // Refused for as long as the membership holds.
    if (setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &now, sizeof now) != 0) continue;
    renewed = true;
    // Of 20 that the kernel allows a socket, also those on interfaces that are gone count.
    if (interface_ != 0 && interface_ != leads_there) {
      setsockopt(fd, IPPROTO_IP, IP_DROP_MEMBERSHIP, &former, sizeof former);
    }
  }
  if (renewed) interface_ = leads_there;
  return renewed;
}

}  // namespace ergocast
