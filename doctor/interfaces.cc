#include "doctor/interfaces.h"

#include <arpa/inet.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>

#include <cstring>
#include <memory>

#include "doctor/socket.h"

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

/// RTM_GETROUTE for one IPv4 address.
struct RouteQuestion {
  nlmsghdr header{};
  rtmsg route{};
  rtattr attribute{};
  in_addr destination{};
};

/// The RTA_OIF of the kernel's answer; 0: none.
int interface_in(const char* answer, std::size_t size) {
  nlmsghdr header{};
  if (size < NLMSG_LENGTH(sizeof(rtmsg))) return 0;
  std::memcpy(&header, answer, sizeof header);
  if (header.nlmsg_type != RTM_NEWROUTE || header.nlmsg_len > size) return 0;
  for (std::size_t at = NLMSG_LENGTH(sizeof(rtmsg)); at + sizeof(rtattr) <= header.nlmsg_len;) {
    rtattr attribute{};
    std::memcpy(&attribute, answer + at, sizeof attribute);
    if (attribute.rta_len < sizeof attribute || at + attribute.rta_len > header.nlmsg_len) return 0;
    if (attribute.rta_type == RTA_OIF && attribute.rta_len == RTA_LENGTH(sizeof(int))) {
      int index = 0;
      std::memcpy(&index, answer + at + RTA_LENGTH(0), sizeof index);
      return index;
    }
    at += RTA_ALIGN(attribute.rta_len);
  }
  return 0;
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

// The source address that a connected socket gets would not do: for a route to lo, the kernel takes
// another interface's.
std::optional<std::string> routed_interface(const std::string& group) {
  const Socket socket(AF_NETLINK, SOCK_RAW, NETLINK_ROUTE);
  RouteQuestion question;
  question.header.nlmsg_len = sizeof question;
  question.header.nlmsg_type = RTM_GETROUTE;
  question.header.nlmsg_flags = NLM_F_REQUEST;
  question.route.rtm_family = AF_INET;
  question.route.rtm_dst_len = 32;
  question.attribute.rta_len = RTA_LENGTH(sizeof question.destination);
  question.attribute.rta_type = RTA_DST;
  if (inet_pton(AF_INET, group.c_str(), &question.destination) != 1) return std::nullopt;
  if (send(socket.fd(), &question, sizeof question, 0) < 0) return std::nullopt;
  char answer[4096];
  const ssize_t size = recv(socket.fd(), answer, sizeof answer, 0);
  const int index = size < 0 ? 0 : interface_in(answer, static_cast<std::size_t>(size));
  char name[IF_NAMESIZE] = "";
  if (index == 0 || if_indextoname(static_cast<unsigned>(index), name) == nullptr) {
    return std::nullopt;
  }
  return name;
}

}  // namespace ergocast::doctor
