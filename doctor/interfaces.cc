#include "doctor/interfaces.h"

#include <arpa/inet.h>
#include <net/if.h>
#include <sys/ioctl.h>

#include <cstring>
#include <memory>

#include "runtime/multicast_route.h"
#include "runtime/socket.h"

namespace ergocast::doctor {
namespace {

Interface look_at(int socket, const char* name) {
  Interface found;
  found.name = name;
  ifreq request{};
  std::strncpy(request.ifr_name, name, IFNAMSIZ - 1);
  if (ioctl(socket, SIOCGIFFLAGS, &request) == 0) {
    const auto flags = static_cast<unsigned>(static_cast<unsigned short>(request.ifr_flags));
    found.up = (flags & IFF_UP) != 0;
    found.carrier = (flags & IFF_RUNNING) != 0;
    found.loopback = (flags & IFF_LOOPBACK) != 0;
    found.multicast = (flags & IFF_MULTICAST) != 0;
  }
  if (ioctl(socket, SIOCGIFMTU, &request) == 0) found.mtu_bytes = request.ifr_mtu;
  if (ioctl(socket, SIOCGIFADDR, &request) == 0) {
    sockaddr_in address{};
    std::memcpy(&address, &request.ifr_addr, sizeof address);
    char text[INET_ADDRSTRLEN] = "";
    inet_ntop(AF_INET, &address.sin_addr, text, sizeof text);
    found.address = text;
  }
  return found;
}

}  // namespace

std::vector<Interface> interfaces() {
  const Socket socket(AF_INET, SOCK_DGRAM);
  const std::unique_ptr<struct if_nameindex, void (*)(struct if_nameindex*)> names(
      if_nameindex(), if_freenameindex);
  std::vector<Interface> found;
  if (!names || socket.fd() < 0) return found;
  for (const auto* one = names.get(); one->if_index != 0; ++one) {
    found.push_back(look_at(socket.fd(), one->if_name));
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
