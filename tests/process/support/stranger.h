// SPDX-License-Identifier: BSD-3-Clause
// A foreign sender on the buses that sends what a test asks for.
#pragma once

#include <cstdint>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <string>
#include <vector>

#include "runtime/bus/lcm_url.h"
#include "runtime/bus/transport.h"
#include "team/messages.h"

namespace ergocast::test {

class Stranger {
 public:
  explicit Stranger(const std::string& url, const MessageAuthenticator& authenticator = {})
      : url_(LcmUrl::parse(url).value()),
        transport_(Transport::open(url_, 0, authenticator, Subscriptions{},
                                   {.on_message = [](const Message&, Bus, AgentId) {}})
                       .value()) {}

  void send(Bus bus, Message message) {
    std::visit([this](auto& m) { m.header.sequence = ++sequence_; }, message);
    transport_->publish({bus, message});
  }
  /// Sends bytes unchanged.
  void send(Bus bus, const std::string& channel, const std::vector<std::byte>& bytes) {
    lcm::LCM raw(url_.of(bus));
    raw.publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
  }

 private:
  LcmUrl url_;
  std::unique_ptr<Transport> transport_;
  std::int64_t sequence_ = 0;
};

}  // namespace ergocast::test
