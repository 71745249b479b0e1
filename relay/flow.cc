// SPDX-License-Identifier: BSD-3-Clause
// A state machine of three steps. Every answer names what it answers, so a recording is ignored.
// Unknown is an exception: a stranger gets one with a recorded Ping.
#include "relay/flow.h"

#include <algorithm>
#include <variant>

namespace ergocast::relay {

Flow::Flow(const Seal& seal, const Identity& identity, std::int64_t& count, const Address& hub,
           Instant now)
    : seal_(seal), identity_(identity), count_(count), hub_(hub) {
  enter(State::kAsking, now);
}

void Flow::enter(State state, Instant now) {
  state_ = state;
  since_ = due_ = heard_ = now;
  // The site's identity is random, so nobody else can name this nonce before it is sent.
  if (state == State::kAsking) nonce_ = identity_.site ^ static_cast<std::uint64_t>(++count_);
  if (state == State::kJoining) join_count_ = ++count_;
  if (state == State::kJoined) pings_.fill({});
  unknown_since_.reset();
}

/// Null if it is none of the last pings.
const Flow::Sent* Flow::ping(std::int64_t count) const {
  const Sent& sent = pings_[static_cast<std::size_t>(count) % pings_.size()];
  return joined() && count > 0 && sent.count == count ? &sent : nullptr;
}

void Flow::send(const Control& control, Outbox& out) const {
  out.packets.push_back({hub_, seal_.write(control)});
}

void Flow::receive(const Control& control, Instant now) {
  std::visit([&](const auto& message) { on(message, now); }, control);
}

void Flow::on(const Cookie& cookie, Instant now) {
  if (state_ != State::kAsking || cookie.nonce != nonce_) return;
  cookie_ = cookie.cookie;
  enter(State::kJoining, now);
}

void Flow::on(const Welcome& welcome, Instant now) {
  if (state_ == State::kJoining && welcome.count == join_count_) enter(State::kJoined, now);
}

void Flow::on(const Pong& pong, Instant now) {
  const Sent* const question = ping(pong.count);
  if (question == nullptr) return;
  heard_ = now;
  unknown_since_.reset();
  round_trip_s_ = std::chrono::duration<double>(now - question->at).count();
}

// The hub has restarted, or a router on the way has given this site another address.
void Flow::on(const Unknown& unknown, Instant now) {
  if (ping(unknown.count) != nullptr && !unknown_since_) unknown_since_ = now;
}

void Flow::advance(Instant now, const FlowCounts& counts, Outbox& out) {
  if (unknown_since_ && now >= *unknown_since_ + kDoubt) enter(State::kAsking, now);
  const bool joined = state_ == State::kJoined;
  if (joined ? now >= heard_ + kSilence : now >= since_ + kPatience) state_ = State::kLost;
  if (state_ == State::kLost || now < due_) return;
  due_ = now + (joined ? kPingPeriod : kRepeat);
  if (state_ == State::kAsking) return send(Ask{identity_.site, nonce_}, out);
  if (state_ == State::kJoining) {
    return send(Join{identity_.site, join_count_, cookie_, identity_.most_bytes_per_s}, out);
  }
  ++count_;
  pings_[static_cast<std::size_t>(count_) % pings_.size()] = {count_, now};
  send(Ping{identity_.site, count_, counts, round_trip_s_}, out);
}

Instant Flow::next_wakeup() const {
  if (state_ == State::kLost) return Instant{};  // at once
  const Instant next = std::min(due_, joined() ? heard_ + kSilence : since_ + kPatience);
  return unknown_since_ ? std::min(next, *unknown_since_ + kDoubt) : next;
}

void Flow::leave(Outbox& out) {
  if (joined()) send(Leave{identity_.site, ++count_}, out);
}

}  // namespace ergocast::relay
