// SPDX-License-Identifier: BSD-3-Clause
// Three buses on which things go wrong: an event queue ordered by (time, insertion).
//
// What happens to a message on a link follows from the seed, the link and how many messages the
// link has carried, and from nothing else. One event carries a message to all whom it reaches at
// the same moment.
#pragma once

#include <bitset>
#include <cstdint>
#include <memory>
#include <optional>
#include <queue>
#include <span>
#include <vector>

#include "core/ids.h"
#include "team/messages.h"
#include "lab/faults.h"

namespace ergocast::lab {

/// Where a process sits: agents 0 … agents − 1, then coordinator, world, recorder.
using NodeId = int;
inline constexpr int kMaxNodes = kMaxAgents + 3;
using NodeSet = std::bitset<kMaxNodes>;

/// How long a message takes that nothing happens to. Above 0, so that no loop stops time.
inline constexpr PacingClock::duration kLatency = std::chrono::microseconds(200);

/// What was done to messages, counted per link.
struct MessageFaults {
  std::int64_t lost = 0, cut = 0, duplicated = 0, replayed = 0, corrupted = 0, delayed = 0, reordered = 0,
               clogs = 0, clogged = 0;
};

struct Delivery {
  Instant at;
  std::uint64_t order;  ///< of insertion
  Bus bus;
  AgentId transmitter;
  NodeSet to;
  std::shared_ptr<const Message> message;
};

class Network {
 public:
  Network(std::uint64_t seed, const Faults& faults, int nodes);

  /// Puts a message on its way from one node to others.
  /// @param transmitter  as receivers see it
  /// @return  how many copies are to be corrupted; they are the caller's to damage and to refuse
  int send(Instant now, NodeId from, const NodeSet& to, Bus bus, AgentId transmitter,
           const std::shared_ptr<const Message>& message);

  /// Instant::max() if nothing is on its way.
  Instant next() const { return queue_.empty() ? Instant::max() : queue_.top().at; }
  Delivery pop();

  /// From now on, `from` is not heard by `to`, until join() has been called as often.
  void cut(NodeId from, NodeId to) { ++link_cuts_[pair_index(from, to)]; }
  void join(NodeId from, NodeId to) { --link_cuts_[pair_index(from, to)]; }
  /// No more faults: cuts end, and what clogged links hold arrives within kLatency.
  void heal(Instant now);

  const MessageFaults& counted() const { return counted_; }

 private:
  struct Link {
    std::uint32_t sent = 0;
    Instant last_arrival{}, clogged_until{};
  };
  struct Fate {
    std::optional<Instant> arrives, arrives_again, is_replayed;
    bool corrupted = false;
  };
  struct Later {
    bool operator()(const Delivery& a, const Delivery& b) const {
      return a.at != b.at ? a.at > b.at : a.order > b.order;
    }
  };

  std::size_t pair_index(NodeId from, NodeId to) const {
    const int index = from * nodes_ + to;
    return static_cast<std::size_t>(index);
  }
  Fate fate_of(Instant now, std::size_t pair, Bus bus);
  Instant arrival(Instant now, Link& link, std::uint32_t link_index, double reorders, double clogs);
  void push(Instant at, Bus bus, AgentId transmitter, const NodeSet& to,
            const std::shared_ptr<const Message>& message);

  std::uint64_t seed_;
  Faults faults_;
  bool quiet_;  // nothing can happen to a message
  int nodes_;
  std::vector<Link> links_;
  std::vector<int> link_cuts_;
  std::priority_queue<Delivery, std::vector<Delivery>, Later> queue_;
  std::uint64_t pushed_ = 0;
  MessageFaults counted_;
};

/// Changes some of `bytes`, cuts some off or adds some, as the seed says; never to what they were.
void damage(std::vector<std::byte>& bytes, std::uint64_t seed, std::uint64_t copy);

}  // namespace ergocast::lab
