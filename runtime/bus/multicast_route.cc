// SPDX-License-Identifier: BSD-3-Clause
// Asks the kernel over netlink for the route to the group and reads the interface from its
// answer.
#include "runtime/bus/multicast_route.h"

#include <linux/rtnetlink.h>

#include <cstddef>
#include <cstring>

#include "runtime/bus/socket.h"

namespace ergocast {
namespace {

/// RTM_GETROUTE for one IPv4 address.
struct RouteQuestion {
  nlmsghdr header{};
  rtmsg route{};
  rtattr attribute{};
  in_addr destination{};
};

/// The RTA_OIF of the kernel's answer; 0: none.
unsigned interface_in(const char* answer, std::size_t size) {
  nlmsghdr header{};
  if (size < NLMSG_LENGTH(sizeof(rtmsg))) return 0;
  std::memcpy(&header, answer, sizeof header);
  if (header.nlmsg_type != RTM_NEWROUTE || header.nlmsg_len > size) return 0;
  for (std::size_t at = NLMSG_LENGTH(sizeof(rtmsg)); at + sizeof(rtattr) <= header.nlmsg_len;) {
    rtattr attribute{};
    std::memcpy(&attribute, answer + at, sizeof attribute);
    if (attribute.rta_len < sizeof attribute || at + attribute.rta_len > header.nlmsg_len) return 0;
    if (attribute.rta_type == RTA_OIF && attribute.rta_len == RTA_LENGTH(sizeof(unsigned))) {
      unsigned index = 0;
      std::memcpy(&index, answer + at + RTA_LENGTH(0), sizeof index);
      return index;
    }
    at += RTA_ALIGN(attribute.rta_len);
  }
  return 0;
}

}  // namespace

// The source address of a connected socket would be wrong. For a route to lo, the kernel takes the
// address of another interface.
unsigned interface_towards(in_addr group) {
  const Socket socket(AF_NETLINK, SOCK_RAW, NETLINK_ROUTE);
  RouteQuestion question;
  question.header.nlmsg_len = sizeof question;
  question.header.nlmsg_type = RTM_GETROUTE;
  question.header.nlmsg_flags = NLM_F_REQUEST;
  question.route.rtm_family = AF_INET;
  question.route.rtm_dst_len = 32;
  question.attribute.rta_len = RTA_LENGTH(sizeof question.destination);
  question.attribute.rta_type = RTA_DST;
  question.destination = group;
  if (send(socket.fd(), &question, sizeof question, 0) < 0) return 0;
  char answer[4096];
  const ssize_t size = recv(socket.fd(), answer, sizeof answer, 0);
  return size < 0 ? 0 : interface_in(answer, static_cast<std::size_t>(size));
}

}  // namespace ergocast
