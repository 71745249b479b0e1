// SPDX-License-Identifier: BSD-3-Clause
// Asks the kernel for addresses, flags and MTU of each interface, and for the route to a group.
#include "cli/doctor/interfaces.h"

#include <arpa/inet.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <sys/ioctl.h>

// After <net/if.h>: this header only adds the missing definitions.
#include <linux/if.h>

#include <algorithm>
#include <cstring>
#include <memory>

#include "runtime/bus/multicast_route.h"
#include "runtime/bus/socket.h"

namespace ergocast::doctor {
namespace {

std::string text_of(const sockaddr& address) {
  sockaddr_in ipv4{};
  std::memcpy(&ipv4, &address, sizeof ipv4);
  char text[INET_ADDRSTRLEN] = "";
  inet_ntop(AF_INET, &ipv4.sin_addr, text, sizeof text);
  return text;
}

int mtu_of(int socket, const std::string& name) {
  ifreq request{};
  std::strncpy(request.ifr_name, name.c_str(), IFNAMSIZ - 1);
  return ioctl(socket, SIOCGIFMTU, &request) == 0 ? request.ifr_mtu : 0;
}

Interface look_at(int socket, const ifaddrs& link) {
  Interface found;
  found.name = link.ifa_name;
  found.up = (link.ifa_flags & IFF_UP) != 0;
  // IFF_RUNNING would be late: the kernel updates it only once a second.
  found.carrier = (link.ifa_flags & IFF_LOWER_UP) != 0;
  found.loopback = (link.ifa_flags & IFF_LOOPBACK) != 0;
  found.multicast = (link.ifa_flags & IFF_MULTICAST) != 0;
  found.mtu_bytes = mtu_of(socket, found.name);
  return found;
}

}  // namespace

std::vector<Interface> interfaces() {
  const Socket socket(AF_INET, SOCK_DGRAM);
  ifaddrs* list = nullptr;
  std::vector<Interface> found;
  if (socket.fd() < 0 || getifaddrs(&list) != 0) return found;
  const std::unique_ptr<ifaddrs, void (*)(ifaddrs*)> owned(list, freeifaddrs);
  // The list begins with an entry for every interface, which has its hardware address; a tunnel has
  // none. Then it has an entry for every address.
  for (const ifaddrs* one = list; one != nullptr; one = one->ifa_next) {
    const int family = one->ifa_addr == nullptr ? AF_PACKET : one->ifa_addr->sa_family;
    if (family == AF_PACKET) found.push_back(look_at(socket.fd(), *one));
    if (family != AF_INET) continue;
    const auto its = std::find_if(found.begin(), found.end(),
                                  [&](const Interface& i) { return i.name == one->ifa_name; });
    if (its != found.end() && its->address.empty()) its->address = text_of(*one->ifa_addr);
  }
  return found;
}

std::optional<std::string> routed_interface(const std::string& group) {
  const unsigned index = interface_towards(address_of(group, 0).sin_addr);
  char name[IF_NAMESIZE] = "";
  if (index == 0 || if_indextoname(index, name) == nullptr) return std::nullopt;
  return name;
}

}  // namespace ergocast::doctor
