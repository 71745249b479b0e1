// SPDX-License-Identifier: BSD-3-Clause
// A host that answers the doctor's probes wrongly.
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>

#include <array>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/doctor/probe.h"
#include "runtime/bus/socket.h"
#include "runtime/process/program_options.h"

namespace ergocast::test {

inline constexpr const char* kTeamsGroup = "239.255.76.67";

/// A host that answers the doctor's probes in its own way.
class PretendedPeer {
 public:
  struct Manners {
    std::string version = ergocast::version();
    std::uint64_t key = 0;
    bool answers = true;
    std::uint32_t most = doctor::kMaxProbes;  ///< probes it sends
    std::function<bool(std::uint32_t)> leaves_out = [](auto) { return false; };  ///< by sequence
    bool twice = false;
    bool gossips = false;  ///< about a peer that the doctor never receives
  };
  PretendedPeer(int port, Manners manners)
      : manners_(std::move(manners)),
        to_(address_of(kTeamsGroup, port)),
        socket_(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK) {
    const int yes = 1;
    setsockopt(socket_.fd(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    EXPECT_EQ(bind(socket_.fd(), reinterpret_cast<const sockaddr*>(&to_), sizeof to_), 0);
    const ip_mreq membership{to_.sin_addr, {htonl(INADDR_ANY)}};
    EXPECT_EQ(
        setsockopt(socket_.fd(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership), 0);
  }

  /// Answers each probe of the doctor with its own probe.
  void turn() {
    std::array<std::byte, 2048> buffer;
    for (ssize_t size; (size = recv(socket_.fd(), buffer.data(), buffer.size(), 0)) > 0;) {
      const auto probe = doctor::read(std::span(buffer.data(), static_cast<std::size_t>(size)));
      if (!probe || probe->nonce == kNonce) continue;
      doctor::Echo& echo = echo_;
      if (echo.nonce == 0) echo = {probe->nonce, probe->sequence, probe->sequence, {}, 0};
      ++(doctor::is_large(probe->sequence) ? echo.received.large : echo.received.small);
      echo.last = probe->sequence;
      if (sequence_ < manners_.most) speak();
    }
  }

 private:
  static constexpr std::uint64_t kNonce = 4711;

  void speak() {
    doctor::Probe own{kNonce, sequence_++, "stranger", manners_.version, {}, manners_.key};
    if (manners_.answers) own.echoes.push_back(echo_);
    if (manners_.gossips) own.echoes.push_back({99, 0, sequence_, {1, 0}, 0});
    if (manners_.leaves_out(own.sequence)) return;
    std::vector<std::byte> bytes;
    doctor::write(own, bytes);
    for (int i = 0; i < (manners_.twice ? 2 : 1); ++i) {
      sendto(socket_.fd(), bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to_),
             sizeof to_);
    }
  }

  Manners manners_;
  sockaddr_in to_;
  Socket socket_;
  doctor::Echo echo_;
  std::uint32_t sequence_ = 0;
};

}  // namespace ergocast::test
