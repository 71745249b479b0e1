// SPDX-License-Identifier: BSD-3-Clause
// An attacker on a team's network: it records its datagrams and sends them again, unchanged.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "cli/doctor/group_listener.h"
#include "runtime/bus/lcm_url.h"
#include "runtime/bus/socket.h"
#include "team/messages.h"

namespace ergocast::test {

/// Works below LCM, so that it sends as fast as the kernel allows.
class Replayer {
 public:
  /// @param stem  the beginning of the recorded channels, without ERGOCAST_
  Replayer(const LcmUrl& url, std::string_view stem)
      : mouth_(AF_INET, SOCK_DGRAM), url_(url), name_("ERGOCAST_" + std::string(stem)) {
    for (int bus = 0; bus < kBusCount; ++bus) {
      ears_.push_back(doctor::group_listener(url.group, url.base_port + bus, error_));
    }
  }

  /// Records the waiting datagrams; call it before the first replay.
  void listen() {
    constexpr std::size_t kMost = 20000;
    for (int bus = 0; bus < kBusCount; ++bus) {
      std::string space(2048, '\0');
      ssize_t size = 0;
      while ((size = recv(ears_[static_cast<std::size_t>(bus)].fd(), space.data(), space.size(),
                          0)) > 0) {
        const bool ours = std::string_view(space).substr(kLcmHeaderBytes).starts_with(name_);
        if (ours && kept_.size() < kMost) {
          kept_.push_back({bus, space.substr(0, static_cast<std::size_t>(size))});
        }
      }
    }
  }
  std::size_t kept() const { return kept_.size(); }

  /// Sends that many of the recorded datagrams, in turn. After the first call it records no more.
  void replay(std::size_t count) {
    ears_.clear();
    for (; count > 0; --count, ++next_) {
      const Datagram& one = kept_[next_ % kept_.size()];
      const sockaddr_in to = address_of(url_.group, url_.base_port + one.bus);
      sendto(mouth_.fd(), one.bytes.data(), one.bytes.size(), 0,
             reinterpret_cast<const sockaddr*>(&to), sizeof to);
    }
  }

 private:
  static constexpr std::size_t kLcmHeaderBytes = 8;
  struct Datagram {
    int bus;
    std::string bytes;
  };
  Socket mouth_;
  LcmUrl url_;
  std::string name_, error_;
  std::vector<Socket> ears_;
  std::vector<Datagram> kept_;
  std::size_t next_ = 0;
};

}  // namespace ergocast::test
