// SPDX-License-Identifier: BSD-3-Clause
// The three buses as one process uses them: verified messages in, messages out.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/base/ids.h"
#include "core/base/result.h"
#include "lcmtypes/message_authenticator.h"
#include "runtime/bus/gathering.h"
#include "runtime/bus/lcm_url.h"
#include "runtime/bus/rate_limit.h"
#include "team/messages.h"
#include "team/subscriptions.h"

namespace ergocast {

/// A process wakes up at least this often.
inline constexpr std::chrono::nanoseconds kLongestWait = std::chrono::seconds(1);

class Transport {
 public:
  /// The receivers of datagrams; all but the first are optional. `on_accepted` gets the bytes.
  /// `transmitter` is the message's sender, or the agent that relays it.
  struct Handlers {
    std::function<void(const Message&, Bus, AgentId transmitter)> on_message = {};
    std::function<void(Refusal)> on_refused = {};
    std::function<void(Bus, std::string_view channel, std::span<const std::byte>)> on_accepted = {};
    /// Messages of `ergocast replay`; other handlers do not get them.
    std::function<void(const Message&, Bus, AgentId transmitter)> on_replayed = {};
  };

  /// Opens every bus for publishing and listens where `subscriptions` has a message. An error names
  /// its remedy.
  /// @param run  the only run accepted; 0 accepts any until set_run()
  /// @param authenticator  signs and tags published messages. Messages that it does not verify are
  ///                       refused
  static Result<std::unique_ptr<Transport>> open(const LcmUrl& url, RunId run,
                                                 const MessageAuthenticator& authenticator,
                                                 const Subscriptions& subscriptions,
                                                 Handlers handlers);
  virtual ~Transport() = default;

  virtual void set_run(RunId run) = 0;
  /// Sends the messages in their order.
  virtual void publish(std::span<const Outgoing> outgoing) = 0;
  void publish(const Outgoing& one) { publish(std::span(&one, 1)); }
  /// Sets the rate budget of agents and the world's tick; without a call nothing is limited.
  virtual void limit_agents(const RateBudget& rate_budget, Tick tick) = 0;

  /// From now on, for gathering.at_most after a message, only the world's bus wakes the caller.
  /// Each time it wakes, all buses are read. A bus whose receive buffer is too small for
  /// gathering.datagrams still wakes it. Nothing gathers for 10 s after a bus brought four times as
  /// many.
  virtual void let_gather(const Gathering& gathering) = 0;

  /// Waits until a message arrives, `deadline` has come or `wake_fd` (−1: none) is readable, at
  /// most kLongestWait. Then it passes on what has arrived. The number of datagrams is limited, so
  /// that a flood cannot keep the caller from its work. No datagram makes it throw.
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

  /// Whether only messages with the team's key are accepted.
  virtual bool keyed() const = 0;
  /// Whether the kernel drops what this process does not subscribe to.
  virtual bool filtered() const = 0;

  /// The last agent that exceeded its rate budget, so that messages were refused; kUnassigned:
  /// none.
  AgentId rate_offender() const { return rate_offender_; }
  /// Refused messages of agents that exceeded their budget themselves, without repeats by others.
  std::int64_t over_rate() const { return over_rate_; }

  /// Datagrams that the kernel dropped at our sockets for want of buffer space
  /// (runtime/bus/bus_reader.h).
  virtual std::int64_t kernel_drops() = 0;

  /// Listens on the network interface of the current route to the group; true if it is a new one.
  virtual bool renew_membership() = 0;

 protected:
  RefusalCounts refused_{};
  UnknownFormat unknown_format_;
  AgentId rate_offender_ = kUnassigned;
  std::int64_t over_rate_ = 0;
};

}  // namespace ergocast
