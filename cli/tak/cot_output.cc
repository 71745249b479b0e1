// SPDX-License-Identifier: BSD-3-Clause
// A connected UDP socket: so the kernel tells if nobody receives at a host's port.
#include "cli/tak/cot_output.h"

#include <netdb.h>

#include <cerrno>
#include <chrono>
#include <cstring>
#include <memory>
#include <string_view>
#include <utility>

#include "cli/report_error.h"
#include "runtime/bus/clock.h"

namespace ergocast::cli {
namespace {

constexpr std::string_view kScheme = "udp://";

relay::HostAndPort destination(const std::string& text) {
  if (text.starts_with(kScheme)) {
    auto place = relay::HostAndPort::parse_hub(std::string_view(text).substr(kScheme.size()));
    if (place) return *std::move(place);
  }
  throw CLI::ValidationError(
      "--cot", "\"" + text + "\" is no udp://HOST:PORT, such as udp://239.2.3.1:6969");
}

/// Linux sends to a multicast group only within the local network, and also to this host.
Result<Socket> connected(const relay::HostAndPort& to) {
  addrinfo hints{}, *first = nullptr;
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  const int error = getaddrinfo(to.host.c_str(), std::to_string(to.port).c_str(), &hints, &first);
  if (error != 0) return failure(to.host + ": " + gai_strerror(error));
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> addresses(first, freeaddrinfo);
  std::string problem;
  for (const addrinfo* one = first; one != nullptr; one = one->ai_next) {
    Socket socket(one->ai_family, SOCK_DGRAM | SOCK_NONBLOCK);
    if (socket.fd() < 0) {
      problem = no_socket(errno);
    } else if (connect(socket.fd(), one->ai_addr, one->ai_addrlen) == 0) {
      return socket;
    } else {
      problem = to_text(to) + ": " + std::strerror(errno);
    }
  }
  return failure(problem);
}

}  // namespace

CLI::Option* add_cot_option(CLI::App& app, CotOptions& options) {
  return app
      .add_option_function<std::string>(
          "--cot", [&options](const std::string& text) { options.to = destination(text); },
          "Also send robots, closed zones, contacts and found objects to TAK, as Cursor on Target "
          "events. The place may be a multicast group, such as udp://239.2.3.1:6969. The scenario "
          "needs an origin")
      ->type_name("udp://HOST:PORT");
}

Result<CotOutput> CotOutput::open(const relay::HostAndPort& to, const GeoPlace& origin) {
  auto socket = connected(to);
  if (!socket) return failure("no events can be sent to " + socket.error());
  return CotOutput(std::string(kScheme) + to_text(to), origin, *std::move(socket));
}

void CotOutput::show(const TeamPicture& picture, const MissionFollower& team) {
  const WallTime time = std::chrono::system_clock::now();
  for (const CotEvent& event : events_.due(picture, *team.mission(), now()))
    send(cot_xml(event, time));
}

void CotOutput::send(const std::string& datagram) {
  ++sent_;
  if (::send(socket_.fd(), datagram.data(), datagram.size(), MSG_NOSIGNAL) >= 0) return;
  if (++lost_ == 1)
    print_message("events to " + to_ + " are lost: " + std::strerror(errno) +
                  "; the team goes on, and sending too");
}

std::string CotOutput::losses() const {
  if (lost_ == 0) return {};
  return std::to_string(lost_) + " of " + std::to_string(sent_) + " events to " + to_ +
         " were lost";
}

}  // namespace ergocast::cli
