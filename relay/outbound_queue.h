// SPDX-License-Identifier: BSD-3-Clause
// What waits for one flow. Where the link is full, newer replaces older: a flow that is too narrow
// carries each message more rarely, and not later and later.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <list>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "core/base/ids.h"
#include "relay/gate.h"
#include "team/messages.h"

namespace ergocast::relay {

/// Datagrams that were not sent, by cause.
struct Dropped {
  std::int64_t replaced = 0;   ///< by a newer one
  std::int64_t overtaken = 0;  ///< older than the one that waits
  std::int64_t overflow = 0;   ///< beyond the queue's limit
  std::int64_t total() const { return replaced + overtaken + overflow; }
};

class OutboundQueue {
 public:
  /// Limit (Network): bytes that wait for one flow of a relay [bytes]. Beyond it: the oldest and
  /// least urgent datagram is dropped and counted.
  static constexpr std::size_t kMostBytes = 1 << 20;

  /// @pre the gate has admitted it
  /// @param full  whether the link is: then it may replace an older one, but no part of a whole
  ///              that is already being sent
  void add(const Admitted& admitted, Bus bus, std::span<const std::byte> datagram, bool full);
  /// Removes a copy, which the receiver has got in another way.
  void remove(const Admitted& admitted);

  bool empty() const { return bytes_ == 0; }
  struct Waiting {
    Bus bus = Bus::kSwarm;
    std::vector<std::byte> datagram;
    std::optional<Place> place{};
    std::int64_t newness = 0;
    std::optional<Tick> whole{};
    Identity identity{};
  };
  /// The next in turn: an order if one waits. The others share the flow by the weights of their
  /// urgencies, so that no kind starves. @pre !empty()
  const Waiting& next() const { return lines_[turn()].front(); }
  /// Removes next(), which was sent.
  void pop();

  const Dropped& dropped() const { return dropped_; }

 private:
  using Line = std::list<Waiting>;
  struct At {
    std::size_t line = 0;
    Line::iterator waiting{};
  };
  std::size_t turn() const;
  std::size_t turn_without_orders() const;  // kUrgencies if nothing else waits
  void begin(std::size_t line);
  void replace(Waiting& old, const Admitted& admitted, std::span<const std::byte> datagram);
  bool has_begun(const Waiting& waiting) const;
  void erase(std::size_t line, Line::iterator waiting);
  void make_room();

  std::array<Line, kUrgencies> lines_;
  std::map<Place, At> places_;
  std::optional<Place> begun_;  // of the whole (its first part, tick as revision) sent last
  std::array<double, kUrgencies> passes_{};  // bytes sent by weight; the least is next in turn
  std::size_t bytes_ = 0;
  Dropped dropped_;
};

/// How many bytes may be sent by now: a rate, with what a short pause has saved.
class SendBudget {
 public:
  /// @param bytes_per_s  0: no limit
  explicit SendBudget(double bytes_per_s) : bytes_per_s_(bytes_per_s) {}

  bool has_left(Instant now);
  /// A packet may cost more than is left. The next one then waits longer.
  void spend(std::size_t bytes) { left_ -= static_cast<double>(bytes); }
  /// When has_left() will be true. @pre it was false just now
  Instant ready_at() const;

 private:
  double bytes_per_s_;
  double left_ = 0;
  Instant at_{};
};

/// One direction of a flow: the queue, its rate, and packets of several datagrams.
class Sender {
 public:
  /// What UDP and IP add to a packet. The rate counts it.
  static constexpr std::size_t kHeaderBytes = 28;

  explicit Sender(std::int64_t most_bytes_per_s) : budget_(static_cast<double>(most_bytes_per_s)) {}

  /// @pre the gate has admitted it
  void add(const Admitted& admitted, Bus bus, std::span<const std::byte> datagram) {
    queue_.add(admitted, bus, datagram, full_);
  }
  void remove(const Admitted& admitted) { queue_.remove(admitted); }
  const Dropped& dropped() const { return queue_.dropped(); }
  /// The next packet; nothing while the rate is spent, or nothing waits.
  std::optional<std::vector<std::byte>> next_packet(Instant now);
  /// When there may be a packet; Instant::max() if nothing waits.
  Instant next_wakeup() const { return queue_.empty() ? Instant::max() : budget_.ready_at(); }
  std::int64_t datagrams_sent() const { return datagrams_sent_; }
  std::int64_t bytes_sent() const { return bytes_sent_; }

 private:
  OutboundQueue queue_;
  SendBudget budget_;
  bool full_ = false;  // something waits because the rate is spent
  std::int64_t datagrams_sent_ = 0, bytes_sent_ = 0;
};

}  // namespace ergocast::relay
