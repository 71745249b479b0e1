// SPDX-License-Identifier: BSD-3-Clause
// The three LCM buses as one process uses them: checked messages in, messages out.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>

#include "core/ids.h"
#include "team/messages.h"
#include "team/subscriptions.h"
#include "lcmtypes/seal.h"
#include "runtime/lcm_url.h"
#include "runtime/rate_limit.h"

namespace ergocast {

/// A process looks around at least this often, whatever it waits for.
inline constexpr std::chrono::nanoseconds kLongestWait = std::chrono::seconds(1);

class Transport {
 public:
  /// What becomes of a datagram; all but the first may be left out. `on_accepted` sees the bytes.
  /// `transmitter` is the message's sender, or whoever relays it.
  struct Handlers {
    std::function<void(const Message&, Bus, AgentId transmitter)> on_message;
    std::function<void(Refusal)> on_refused = {};
    std::function<void(Bus, std::string_view channel, std::span<const std::byte>)> on_accepted = {};
  };

  /// Opens every bus, to publish on; listens where `hears` has a message. An error says what would
  /// mend it.
  /// @param run  the only run accepted; 0 accepts any until set_run()
  /// @param seal  closes what is published, and what it does not open is refused
  static std::variant<std::unique_ptr<Transport>, std::string> open(
      const LcmUrl& url, RunId run, const Seal& seal, const Subscriptions& hears,
      Handlers handlers);
  virtual ~Transport() = default;

  virtual void set_run(RunId run) = 0;
  virtual void publish(const Outgoing& outgoing) = 0;
  /// What an agent may say from now on, and how far the world is; nothing is limited before.
  virtual void limit_agents(const Allowance& allowance, Tick tick) = 0;

  /// Waits until something arrives, `deadline` has come or `wake_fd` (−1: none) is readable, for
  /// kLongestWait at most, and hands over what has arrived; at most a bounded number of datagrams, so that a flood cannot
  /// keep the caller from its work. Nothing that arrives makes it throw.
  /// @return when it stopped waiting
  virtual Instant deliver_until(Instant deadline, int wake_fd) = 0;

  /// How many datagrams were refused, by reason.
  const RefusalCounts& refused() const { return refused_; }

  /// Datagrams on our channels whose LCM type is none of ours, and the channel of the last one.
  struct UnknownFormat {
    std::int64_t count = 0;
    std::string channel;
  };
  const UnknownFormat& unknown_format() const { return unknown_format_; }

  /// Whether only who has the team's key is believed.
  virtual bool keyed() const = 0;
  /// Whether the kernel keeps from LCM what is none of our messages.
  virtual bool filtered() const = 0;

  /// The last agent that said more than its share, so that some was refused; kUnassigned: none.
  AgentId babbler() const { return babbler_; }
  /// How many were refused for that, and not because others have repeated what an agent once said.
  std::int64_t babbled() const { return babbled_; }

  /// Datagrams that the kernel dropped at our sockets for want of buffer space.
  virtual std::int64_t kernel_drops() const = 0;

  /// Listens on the network interface that now leads to the group; true if it is a new one.
  virtual bool renew_membership() = 0;

 protected:
  RefusalCounts refused_{};
  UnknownFormat unknown_format_;
  AgentId babbler_ = kUnassigned;
  std::int64_t babbled_ = 0;
};

}  // namespace ergocast
