// SPDX-License-Identifier: BSD-3-Clause
// A line for each urgency. A message that replaces another keeps its turn, so that one that is sent
// often does not move itself to the end for ever.
#include "relay/outbound_queue.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/base/require.h"
#include "relay/packets.h"

namespace ergocast::relay {
namespace {

constexpr std::size_t kOrders = static_cast<std::size_t>(Urgency::kOrder);
/// The shares of a full link. Orders come first and have none.
constexpr std::array<double, kUrgencies> kWeights{1, 6, 4, 3, 3, 1, 1};
/// What an idle flow may send at once, as a time at its rate, and at least one packet.
constexpr double kBurstS = 0.05;
constexpr double kLeastBurstBytes = 3000;

Place whole_of(Place part, Tick tick) {
  part.part = 0;
  part.revision = tick;
  return part;
}

}  // namespace

void OutboundQueue::add(const Admitted& admitted, Bus bus, std::span<const std::byte> datagram,
                        bool full) {
  const auto line = static_cast<std::size_t>(admitted.urgency);
  if (admitted.place && full) {
    const auto known = places_.find(*admitted.place);
    if (known != places_.end()) {
      Waiting& old = *known->second.waiting;
      if (admitted.newness < old.newness) return void(++dropped_.overtaken);
      if (admitted.whole == old.whole || !has_begun(old)) {
        ++dropped_.replaced;
        return replace(old, admitted, datagram);
      }
    }
  }
  if (lines_[line].empty()) begin(line);
  lines_[line].push_back({.bus = bus,
                          .datagram = {datagram.begin(), datagram.end()},
                          .place = admitted.place,
                          .newness = admitted.newness,
                          .whole = admitted.whole,
                          .identity = admitted.identity});
  bytes_ += datagram.size();
  if (admitted.place) places_[*admitted.place] = {line, std::prev(lines_[line].end())};
  make_room();
}

void OutboundQueue::replace(Waiting& old, const Admitted& admitted,
                            std::span<const std::byte> datagram) {
  bytes_ += datagram.size() - old.datagram.size();
  old.datagram.assign(datagram.begin(), datagram.end());
  old.newness = admitted.newness;
  old.whole = admitted.whole;
  old.identity = admitted.identity;
  make_room();
}

/// Whether a part of the same whole was sent. Then no newer part replaces the others, which follow.
bool OutboundQueue::has_begun(const Waiting& waiting) const {
  return waiting.whole && begun_ == whole_of(*waiting.place, *waiting.whole);
}

void OutboundQueue::remove(const Admitted& admitted) {
  if (!admitted.place) return;
  const auto known = places_.find(*admitted.place);
  if (known == places_.end() || known->second.waiting->identity != admitted.identity) return;
  const At at = known->second;
  erase(at.line, at.waiting);
}

void OutboundQueue::pop() {
  const std::size_t line = turn();
  if (next().whole) begun_ = whole_of(*next().place, *next().whole);
  passes_[line] += static_cast<double>(next().datagram.size()) / kWeights[line];
  erase(line, lines_[line].begin());
}

/// A line that begins anew does not catch up on the time when it had nothing to send. It owes
/// nothing for the time when no other line had anything to send.
void OutboundQueue::begin(std::size_t line) {
  const std::size_t busy = turn_without_orders();
  if (busy == kUrgencies) {
    passes_.fill(0);
  } else {
    passes_[line] = std::max(passes_[line], passes_[busy]);
  }
}

std::size_t OutboundQueue::turn() const {
  ERGOCAST_REQUIRE(!empty());
  return lines_[kOrders].empty() ? turn_without_orders() : kOrders;
}

std::size_t OutboundQueue::turn_without_orders() const {
  std::size_t best = kUrgencies;
  for (std::size_t line = kOrders + 1; line < kUrgencies; ++line) {
    if (lines_[line].empty()) continue;
    if (best == kUrgencies || passes_[line] < passes_[best]) best = line;
  }
  return best;
}

void OutboundQueue::erase(std::size_t line, Line::iterator waiting) {
  bytes_ -= waiting->datagram.size();
  if (waiting->place) {
    const auto known = places_.find(*waiting->place);
    if (known != places_.end() && known->second.waiting == waiting) places_.erase(known);
  }
  lines_[line].erase(waiting);
}

void OutboundQueue::make_room() {
  while (bytes_ > kMostBytes) {
    std::size_t line = kUrgencies - 1;
    while (lines_[line].empty()) --line;
    ++dropped_.overflow;
    erase(line, lines_[line].begin());
  }
}

bool SendBudget::has_left(Instant now) {
  if (bytes_per_s_ <= 0) return true;
  const double burst = std::max(kLeastBurstBytes, kBurstS * bytes_per_s_);
  const double gained = std::chrono::duration<double>(now - at_).count() * bytes_per_s_;
  left_ = std::min(burst, left_ + gained);
  at_ = now;
  return left_ > 0;
}

Instant SendBudget::ready_at() const {
  if (bytes_per_s_ <= 0 || left_ > 0) return at_;
  return at_ + seconds(-left_ / bytes_per_s_) + std::chrono::nanoseconds(1);
}

std::optional<std::vector<std::byte>> Sender::next_packet(Instant now) {
  full_ = !queue_.empty() && !budget_.has_left(now);
  if (queue_.empty() || full_) return std::nullopt;
  std::vector<std::byte> packet;
  do {
    append_frame(packet, queue_.next().bus, queue_.next().datagram);
    queue_.pop();
    ++datagrams_sent_;
  } while (!queue_.empty() &&
           packet.size() + frame_bytes(queue_.next().datagram.size()) <= kBundleBytes);
  bytes_sent_ += static_cast<std::int64_t>(packet.size() + kHeaderBytes);
  budget_.spend(packet.size() + kHeaderBytes);
  return packet;
}

}  // namespace ergocast::relay
