// SPDX-License-Identifier: BSD-3-Clause
// The local LCM group as a relay uses it: whole datagrams in and out, on all three buses.
#pragma once

#include <netinet/in.h>

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"
#include "relay/address.h"
#include "runtime/bus/group_membership.h"
#include "runtime/bus/lcm_url.h"
#include "runtime/bus/socket.h"
#include "team/messages.h"

namespace ergocast::relay {

class LocalGroup {
 public:
  /// @param others  receives every datagram, not only messages of Ergocast
  static Result<LocalGroup> open(const LcmUrl& url, bool others);

  std::array<int, kBusCount> fds() const;
  /// Passes on what waits on each bus, at most `most` datagrams of one. Never waits.
  void receive(std::size_t most,
               const std::function<void(Bus, std::span<const std::byte>)>& on_datagram);
  /// Sends a datagram as it is.
  void send(const GroupDatagram& datagram);
  /// Listens on the interface of the current route; true if it is a new one.
  bool renew_membership() { return membership_->renew(); }

 private:
  explicit LocalGroup(const LcmUrl& url);

  std::vector<Socket> readers_;  // by bus
  Socket writer_;
  std::array<sockaddr_in, kBusCount> buses_{};
  std::optional<GroupMembership> membership_;
  std::vector<std::byte> space_;
};

}  // namespace ergocast::relay
