// SPDX-License-Identifier: BSD-3-Clause
// Draws the fate of each copy of a message from the seed, the link and the number of the
// message.
#include "lab/network.h"

#include <algorithm>
#include <utility>

#include "core/base/noise.h"
#include "core/base/portable_math.h"

namespace ergocast::lab {
namespace {

/// Random streams beside those of lab/faults.cc: one for each link and purpose.
constexpr std::uint32_t kWhether = 1U << 20, kHowLong = 2U << 20, kDamage = 3U << 20,
                        kReplay = 4U << 20, kCrossing = 5U << 20;

/// A link's draws of one kind.
std::uint32_t stream(std::uint32_t kind, std::uint32_t link) {
  constexpr std::uint32_t kLow = (1U << 20) - 1;
  return kind | (link & kLow) | (link & ~kLow) << 4;
}

double unit(std::uint32_t word) { return (word + 0.5) * 0x1p-32; }

bool quiet(const Faults& f) {
  return f.loss <= 0 && f.duplication <= 0 && f.corruption <= 0 && f.delay_mean_s <= 0 &&
         f.reordering <= 0 && f.clogging <= 0 && f.replay <= 0 && !has_bad_links(f);
}

}  // namespace

Network::Network(std::uint64_t seed, const Faults& faults, int agents, int nodes,
                 PacingClock::duration latency)
    : seed_(seed),
      faults_(faults),
      quiet_(quiet(faults)),
      agents_(agents),
      nodes_(nodes),
      sites_(site_count(faults)),
      latency_(latency),
      links_(static_cast<std::size_t>(nodes * nodes * kBusCount)),
      link_cuts_(static_cast<std::size_t>(nodes * nodes)),
      crossed_(static_cast<std::size_t>(nodes * sites_ * kBusCount)),
      crossings_(static_cast<std::size_t>(sites_)) {}

int Network::send(Instant now, NodeId from, const NodeSet& to, Bus bus, AgentId transmitter,
                  std::shared_ptr<Decoded> read) {
  if (quiet_ && cuts_ == 0) {
    push(now + latency_, {bus, transmitter, to, std::move(read)});
    return 0;
  }
  start_crossings(from, to, bus);
  NodeSet at_once;  // all nodes that the message reaches without a fault
  int corrupted = 0;
  for (NodeId node = 0; node < nodes_; ++node) {
    const auto bit = static_cast<std::size_t>(node);
    if (!to.test(bit)) continue;
    if (node == from) {  // a node's own messages do not cross the network
      at_once.set(bit);
      continue;
    }
    Crossing& crossing = crossings_[static_cast<std::size_t>(site_of(node, agents_, sites_))];
    if (!crossing.takes) continue;
    const Instant at_site = now + *crossing.takes;
    const Fate fate = fate_of(at_site, pair_index(from, node), bus);
    corrupted += fate.corrupted ? 1 : 0;
    for (const auto& arrival : {fate.arrives, fate.arrives_again, fate.is_replayed}) {
      if (!arrival) continue;
      NodeSet& together = *crossing.takes == PacingClock::duration(0) ? at_once : crossing.to;
      if (*arrival == at_site + latency_ && !together.test(bit)) {
        together.set(bit);
      } else {
        push(*arrival, {bus, transmitter, NodeSet().set(bit), read});
      }
    }
  }
  for (const Crossing& crossing : crossings_) {
    if (crossing.to.any()) {
      push(now + *crossing.takes + latency_, {bus, transmitter, crossing.to, read});
    }
  }
  if (at_once.any()) {
    push(now + latency_, {bus, transmitter, at_once, std::move(read)});
  }
  return corrupted;
}

/// What the relays' links do to a message. One datagram reaches a site, or none does.
void Network::start_crossings(NodeId from, const NodeSet& to, Bus bus) {
  const int home = site_of(from, agents_, sites_);
  const bool wired = faults_.swarm_bus_only > 0 && bus != Bus::kSwarm;
  for (int site = 0; site < sites_; ++site) {
    Crossing& crossing = crossings_[static_cast<std::size_t>(site)];
    crossing = {PacingClock::duration(0), {}};
    if (site == home || wired || quiet_) continue;
    const auto index = static_cast<std::uint32_t>((from * sites_ + site) * kBusCount) +
                       static_cast<std::uint32_t>(bus);
    const auto draw =
        uniform_pair(seed_, Purpose::kFault, stream(kCrossing, index), ++crossed_[index]);
    const double late_s = faults_.link_delay_s + faults_.link_jitter_s * (2 * draw.y() - 1);
    crossing.takes = seconds(std::max(0.0, late_s));
    const bool cut = cut_site_ && (site == *cut_site_ || home == *cut_site_);
    if (!cut && draw.x() >= faults_.link_loss) continue;
    crossing.takes.reset();
    // For each process, as all other faults are counted.
    for (NodeId node = 0; node < nodes_; ++node) {
      if (!to.test(static_cast<std::size_t>(node)) || site_of(node, agents_, sites_) != site)
        continue;
      ++(cut ? counted_.cut : counted_.lost);
    }
  }
}

Network::Fate Network::fate_of(Instant now, std::size_t pair, Bus bus) {
  if (link_cuts_[pair] > 0) {
    ++counted_.cut;
    return {};
  }
  const bool wired = faults_.swarm_bus_only > 0 && bus != Bus::kSwarm;
  if (quiet_ || wired) return {now + latency_, {}, {}, false};
  const auto index = static_cast<std::uint32_t>(pair) * kBusCount + static_cast<std::uint32_t>(bus);
  Link& link = links_[index];
  const RandomBits random =
      random_words(seed_, Purpose::kFault, stream(kWhether, index), ++link.sent);
  const auto upper = [](std::uint64_t word) {
    return unit(static_cast<std::uint32_t>(word >> 32));
  };
  const auto lower = [](std::uint64_t word) { return unit(static_cast<std::uint32_t>(word)); };
  Fate fate;
  const auto replay = uniform_pair(seed_, Purpose::kFault, stream(kReplay, index), link.sent);
  if (replay.x() < faults_.replay) {
    ++counted_.replayed;
    fate.is_replayed = now + latency_ + seconds(faults_.replay_max_s * replay.y());
  }
  // One draw for faults that exclude each other.
  const double what = upper(random.first);
  if (what < faults_.loss) {
    ++counted_.lost;
    return fate;
  }
  if (what < faults_.loss + faults_.corruption) {
    ++counted_.corrupted;
    fate.corrupted = true;
    return fate;
  }
  fate.arrives = arrival(now, link, index, upper(random.second), lower(random.second));
  if (lower(random.first) < faults_.duplication) {
    ++counted_.duplicated;
    fate.arrives_again = *fate.arrives + latency_;
  }
  return fate;
}

Instant Network::arrival(Instant now, Link& link, std::uint32_t link_index, double reorders,
                         double clogs) {
  Instant at = now + latency_;
  const auto how_long =
      uniform_pair(seed_, Purpose::kFault, stream(kHowLong, link_index), link.sent);
  if (faults_.delay_mean_s > 0) {
    const double delay_s = -faults_.delay_mean_s * portable::log(how_long.x());
    at += seconds(std::min(delay_s, faults_.delay_max_s));
    ++counted_.delayed;
  }
  if (reorders < faults_.reordering) {
    ++counted_.reordered;
    return at + seconds(faults_.reordering_max_s * how_long.y());
  }
  if (now >= link.clogged_until && clogs < faults_.clogging) {
    ++counted_.clogs;
    link.clogged_until = now + seconds(faults_.clog_max_s * how_long.y());
  }
  if (at < link.clogged_until) {
    ++counted_.clogged;
    at = link.clogged_until;
  }
  return link.last_arrival = std::max(at, link.last_arrival);
}

void Network::push(Instant at, Delivery delivery) {
  // Most arrive after everything that is on its way.
  queue_.emplace_hint(queue_.end(), std::pair(at, pushed_++), std::move(delivery));
}

Delivery Network::pop() {
  const auto first = queue_.begin();
  Delivery next = std::move(first->second);
  queue_.erase(first);
  return next;
}

void Network::heal(Instant now) {
  faults_ = {};
  quiet_ = true;
  std::fill(link_cuts_.begin(), link_cuts_.end(), 0);
  cuts_ = 0;
  cut_site_.reset();
  // Messages that are still held back arrive in the order in which they would have arrived.
  for (auto& [when, delivery] : std::exchange(queue_, {})) {
    push(std::min(when.first, now + latency_), std::move(delivery));
  }
}

void damage(std::vector<std::byte>& bytes, std::uint64_t seed, std::uint64_t copy) {
  const RandomBits random = random_words(seed, Purpose::kFault, kDamage, copy);
  const std::size_t where = random.first % bytes.size();
  switch (random.second % 4) {
    case 0:
      bytes.resize(where);
      return;
    case 1:
      bytes.resize(bytes.size() + 1 + where, std::byte{0});
      return;
    case 2:
      bytes[where] ^= std::byte{1} << (random.second >> 2) % 8;
      return;
    default:
      for (std::size_t i = where; i < std::min(where + 16, bytes.size()); ++i)
        bytes[i] ^= std::byte{0x5a};
  }
}

}  // namespace ergocast::lab
