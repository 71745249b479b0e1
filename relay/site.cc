// SPDX-License-Identifier: BSD-3-Clause
// Keeps one flow and, while it looks for a better hub, a candidate for the next.
#include "relay/site.h"

#include <algorithm>
#include <utility>

namespace ergocast::relay {
namespace {

/// Limit (Network): addresses of one name that a relay tries. Beyond it: it tries the first ones.
constexpr std::size_t kMostAddresses = 8;

}  // namespace

Site::Site(const Settings& settings, const MessageAuthenticator& authenticator, SiteId id)
    : settings_(settings),
      seal_(authenticator.key()),
      identity_{id, settings.most_bytes_per_s},
      carrier_(authenticator, settings.others) {}

std::optional<std::size_t> Site::joined() const {
  return flow_ && flow_->joined() ? std::optional(flow_hub_) : std::nullopt;
}

void Site::take_local(Bus bus, std::span<const std::byte> datagram, Instant now) {
  // What waited while the site is cut off would be old when the path is back. The team's own
  // repeats make up for it.
  const auto admitted = carrier_.from_group(bus, datagram, joined().has_value(), now);
  if (admitted) sender_->add(*admitted, bus, datagram);
}

void Site::receive(std::span<const std::byte> packet, const Address& from, Instant now,
                   Outbox& out) {
  const bool of_flow = flow_ && flow_->hub() == from;
  const bool of_candidate = candidate_ && candidate_->hub() == from;
  if (packet.empty() || !(of_flow || of_candidate)) return;
  if (packet[0] != kDataKind) {
    const auto control = seal_.read(packet);
    if (!control) return;
    const bool was_joined = joined().has_value();
    (of_flow ? *flow_ : *candidate_).receive(*control, now);
    if (joined() && !was_joined) begin_counts();
    if (of_flow && std::holds_alternative<Pong>(*control))
      flow_counts_.packets_received = packets_received_;
    return;
  }
  if (!of_flow || !joined()) return;
  bool counted = false;
  for (GroupDatagram& datagram : frames_of(packet)) {
    bool copy = false;
    const auto admitted = carrier_.from_flow(datagram, now, copy);
    if (!admitted) break;  // no relay sends it
    if (!std::exchange(counted, true)) ++packets_received_;
    if (!copy) carrier_.put(std::move(datagram), *admitted, now, out);
  }
}

// ---- which hub ----

/// Begins with the first hub. A site that has joined one tries only earlier ones.
void Site::search(Instant now) {
  const std::size_t most = flow_ ? flow_hub_ : settings_.hubs;
  if (try_hub_ >= most) {
    try_hub_ = 0;
    next_search_ = now + (flow_ ? kPreferredPause : kPause);
    return;
  }
  wanted_ = try_hub_;
}

void Site::found(std::vector<Address> addresses, Instant now) {
  if (!wanted_) return;
  wanted_.reset();
  untried_ = std::move(addresses);
  if (untried_.size() > kMostAddresses) untried_.resize(kMostAddresses);
  std::reverse(untried_.begin(), untried_.end());
  try_next_address(now);
}

void Site::try_next_address(Instant now) {
  candidate_.reset();
  if (untried_.empty()) {
    ++try_hub_;
    return search(now);
  }
  const Address next = untried_.back();
  untried_.pop_back();
  if (flow_ && flow_->hub() == next) return try_next_address(now);
  candidate_.emplace(seal_, identity_, count_, next, now);
}

void Site::adopt_candidate(Instant now) {
  end_flow();
  flow_.emplace(*candidate_);
  candidate_.reset();
  flow_hub_ = try_hub_;
  try_hub_ = 0;
  sender_.emplace(settings_.most_bytes_per_s);
  carrier_.give_stops(*sender_, now, now);
  begin_counts();
}

void Site::begin_counts() {
  flow_counts_ = {};
  packets_received_ = 0;
}

void Site::end_flow() {
  if (sender_) carrier_.end(*sender_);
  sender_.reset();
  flow_.reset();
}

void Site::advance(Instant now, Outbox& out) {
  flow_counts_.dropped = sender_ ? sender_->dropped().total() : 0;
  if (flow_) {
    flow_->advance(now, flow_counts_, out);
    if (flow_->state() == Flow::State::kLost) {
      end_flow();
      if (!candidate_ && !wanted_) try_hub_ = 0;
      next_search_ = now;
    }
  }
  if (candidate_) {
    candidate_->advance(now, {}, out);
    if (candidate_->joined()) {
      if (flow_) flow_->leave(out);
      adopt_candidate(now);
      next_search_ = now + kPreferredPause;
      flow_->advance(now, flow_counts_, out);
    } else if (candidate_->state() == Flow::State::kLost) {
      try_next_address(now);
      if (candidate_) candidate_->advance(now, {}, out);
    }
  }
  const bool looks = !flow_ || flow_hub_ > 0;
  if (looks && !candidate_ && !wanted_ && now >= next_search_) search(now);
  send_waiting(now, out);
}

void Site::send_waiting(Instant now, Outbox& out) {
  if (!joined()) return;
  while (auto packet = sender_->next_packet(now)) {
    ++flow_counts_.packets_sent;
    out.packets.push_back({flow_->hub(), *std::move(packet)});
  }
}

Instant Site::next_wakeup() const {
  Instant next = Instant::max();
  if (flow_) next = std::min(next, flow_->next_wakeup());
  if (candidate_) next = std::min(next, candidate_->next_wakeup());
  if (joined()) next = std::min(next, sender_->next_wakeup());
  const bool looks = !flow_ || flow_hub_ > 0;
  if (looks && !candidate_ && !wanted_) next = std::min(next, next_search_);
  return next;
}

void Site::leave(Outbox& out) {
  if (flow_) flow_->leave(out);
}

Counts Site::counts() const {
  Counts counts = carrier_.counts();
  if (sender_) add(*sender_, counts);
  return counts;
}

}  // namespace ergocast::relay
