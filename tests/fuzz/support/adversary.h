// SPDX-License-Identifier: BSD-3-Clause
// An adversary on a team's network: it records messages and sends them back damaged.
#pragma once

#include <cstdint>
#include <string>
#include <unordered_set>
#include <vector>

#include "lcmtypes/message_authenticator.h"
#include "runtime/bus/lcm_url.h"
#include "runtime/bus/socket.h"
#include "tests/fuzz/support/datagrams.h"

namespace ergocast::fuzz {

class Adversary {
 public:
  /// @param authenticator  the team's, only for reading its state. If it has a key, some forgeries
  ///                       get the tag that is valid without a key.
  Adversary(const LcmUrl& url, const MessageAuthenticator& authenticator, std::uint64_t seed);

  /// Reads the waiting datagrams. They are recorded until the first one was sent.
  void listen();
  /// Sends one datagram to one of the buses.
  void strike();

  std::size_t heard() const { return heard_.size(); }
  std::int64_t sent() const { return sent_; }
  /// Whether a message of these bytes was sent by us.
  bool forged(const std::string& channel, std::span<const std::uint8_t> message) const {
    return forgeries_.contains(mark(channel, message));
  }

  /// The world's reports: its tick, and the number of late commands.
  Tick tick() const { return tick_; }
  std::int64_t missed_deadlines() const { return missed_deadlines_; }

 private:
  struct Packet {
    int bus;
    std::string channel;
    std::vector<std::uint8_t> message;
  };

  static std::uint64_t mark(const std::string& channel, std::span<const std::uint8_t> message);
  void take(int bus, std::span<const std::uint8_t> datagram);
  Packet damaged(const Packet& original);
  std::vector<std::uint8_t> wrapped(const Packet& packet);

  LcmUrl url_;
  MessageAuthenticator authenticator_;
  Dice dice_;
  std::vector<Socket> ears_;
  Socket mouth_;
  std::vector<Packet> heard_;
  std::unordered_set<std::uint64_t> forgeries_;
  std::int64_t sent_ = 0;
  Tick tick_ = 0;
  std::int64_t missed_deadlines_ = 0;
};

}  // namespace ergocast::fuzz
