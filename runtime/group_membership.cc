#include "runtime/group_membership.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

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

/// The index of the network interface that leads to `group`; 0 if none does.
unsigned interface_to(in_addr group) {
  const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in there{}, here{};
  there.sin_family = AF_INET;
  there.sin_port = htons(1);
  there.sin_addr = group;
  socklen_t length = sizeof here;
  const bool leads = connect(probe, reinterpret_cast<sockaddr*>(&there), sizeof there) == 0 &&
                     getsockname(probe, reinterpret_cast<sockaddr*>(&here), &length) == 0;
  close(probe);
  ifaddrs* all = nullptr;
  if (!leads || getifaddrs(&all) != 0) return 0;
  unsigned index = 0;
  for (const ifaddrs* one = all; one != nullptr && index == 0; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    const auto* address = reinterpret_cast<const sockaddr_in*>(one->ifa_addr);
    if (address->sin_addr.s_addr == here.sin_addr.s_addr) index = if_nametoindex(one->ifa_name);
  }
  freeifaddrs(all);
  return index;
}

}  // namespace

GroupMembership::GroupMembership(const LcmUrl& url) {
  inet_pton(AF_INET, url.group.c_str(), &group_);
  interface_ = interface_to(group_);
  for (int fd = 0; fd < kMaxDescriptors; ++fd) {
    const int port = bound_port(fd);
    if (port >= url.base_port && port < url.base_port + kBusCount) sockets_.push_back(fd);
  }
}

bool GroupMembership::renew() {
  const ip_mreqn wherever_it_is{group_, {}, 0};
  const ip_mreqn former{group_, {}, static_cast<int>(interface_)};
  bool renewed = false;
  for (const int fd : sockets_) {
    // Refused for as long as the membership holds, and while nothing leads to the group.
    if (setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &wherever_it_is, sizeof wherever_it_is) !=
        0) {
      continue;
    }
    // Of 20 that the kernel allows a socket, also those on interfaces that are gone count.
    if (interface_ != 0) setsockopt(fd, IPPROTO_IP, IP_DROP_MEMBERSHIP, &former, sizeof former);
    renewed = true;
  }
  if (renewed) interface_ = interface_to(group_);
  return renewed;
}

}  // namespace ergocast
