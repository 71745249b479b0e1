// SPDX-License-Identifier: BSD-3-Clause
// Three buses with faults: messages on their way, ordered by (time, insertion).
//
// What happens to a message on a link follows only from the seed, the link and the number of
// messages that the link has carried. One event carries a message to all nodes that it reaches at
// the same moment.
#pragma once

#include <bitset>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "core/base/ids.h"
#include "lab/faults.h"
#include "lcmtypes/codec.h"
#include "team/messages.h"

namespace ergocast::lab {

/// A process: agents 0 … agents − 1, then coordinator, world, logger.
using NodeId = int;
inline constexpr int kMaxNodes = kMaxAgents + 3;
using NodeSet = std::bitset<kMaxNodes>;

/// What was done to messages, counted per link.
struct MessageFaults {
  std::int64_t lost = 0, cut = 0, duplicated = 0, replayed = 0, corrupted = 0, delayed = 0,
               reordered = 0, clogs = 0, clogged = 0;
};

struct Delivery {
  Bus bus;
  AgentId transmitter;
  NodeSet to;
  std::shared_ptr<Decoded> read;  ///< holds a Message
};

class Network {
 public:
  /// @param agents  the first nodes; sites differ by them
  /// @param latency  how long a message without faults takes
  Network(std::uint64_t seed, const Faults& faults, int agents, int nodes,
          PacingClock::duration latency);

  /// Puts a message on its way from one node to others.
  /// @param transmitter  as receivers see it
  /// @return  how many copies are to be corrupted; the caller damages and refuses them
  int send(Instant now, NodeId from, const NodeSet& to, Bus bus, AgentId transmitter,
           std::shared_ptr<Decoded> read);

  /// Instant::max() if nothing is on its way.
  Instant next() const { return queue_.empty() ? Instant::max() : queue_.begin()->first.first; }
  Delivery pop();

  /// From now on `to` receives nothing from `from`, until join() has been called as often.
  void cut(NodeId from, NodeId to) { ++link_cuts_[pair_index(from, to)], ++cuts_; }
  void join(NodeId from, NodeId to) { --link_cuts_[pair_index(from, to)], --cuts_; }
  /// From now on nothing passes between that site and the others, until it is joined again.
  void cut_site(int site) { cut_site_ = site, ++cuts_; }
  void join_site() { cut_site_.reset(), --cuts_; }
  /// No more faults: cuts end, and what clogged links hold arrives within the latency.
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

  std::size_t pair_index(NodeId from, NodeId to) const {
    const int index = from * nodes_ + to;
    return static_cast<std::size_t>(index);
  }
  /// The messages of one send() that arrive at the same site together.
  struct Crossing {
    std::optional<PacingClock::duration> takes;  // nothing: lost
    NodeSet to;                                  // where no other fault applies
  };
  void start_crossings(NodeId from, const NodeSet& to, Bus bus);
  Fate fate_of(Instant now, std::size_t pair, Bus bus);
  Instant arrival(Instant now, Link& link, std::uint32_t link_index, double reorders, double clogs);
  void push(Instant at, Delivery delivery);

  std::uint64_t seed_;
  Faults faults_;
  bool quiet_;  // the only possible fault is a cut link
  int agents_, nodes_, sites_;
  PacingClock::duration latency_;
  std::vector<Link> links_;
  std::vector<int> link_cuts_;
  int cuts_ = 0;  // their sum, with that of a site
  std::optional<int> cut_site_;
  std::vector<std::uint32_t> crossed_;  // messages by node, site and bus
  std::vector<Crossing> crossings_;     // by site, of the message that is sent now
  std::map<std::pair<Instant, std::uint64_t>, Delivery> queue_;
  std::uint64_t pushed_ = 0;
  MessageFaults counted_;
};

/// Changes, cuts off or adds some of `bytes`, as the seed determines. The result always differs.
void damage(std::vector<std::byte>& bytes, std::uint64_t seed, std::uint64_t copy);

}  // namespace ergocast::lab
