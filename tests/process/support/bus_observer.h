// SPDX-License-Identifier: BSD-3-Clause
// A listening process on the buses of a mission: it collects the team's reports.
#pragma once

#include <algorithm>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "runtime/bus/clock.h"
#include "runtime/bus/transport.h"
#include "team/messages.h"
#include "team/mission_follower.h"
#include "tests/process/support/programs.h"

namespace ergocast::test {

class BusObserver {
 public:
  explicit BusObserver(const std::string& url, const MessageAuthenticator& authenticator = {}) {
    transport_ =
        Transport::open(
            LcmUrl::parse(url).value(), 0, authenticator,
            {kTypes<MissionPart, Contribution, Digest, AgentStatus>, 0, kTypes<Command, RecordAck>},
            {.on_message = [this](const Message& message, Bus, AgentId) { receive(message); }})
            .value();
  }

  /// Listens until `condition` holds; false if it never does.
  bool observes(const std::function<bool()>& condition) {
    return eventually(condition, [this] { listen(); });
  }
  /// Listens for a moment; for conditions on several observers.
  void listen() { transport_->deliver_until(now() + std::chrono::milliseconds(5), -1); }

  /// The newest member under that number; incarnation 0 if there is none.
  Author member(AgentId id) const {
    Author member;
    for (const RosterEntry& entry : follower_.roster()) {
      if (entry.author.agent == id && entry.active_until < 0) member = entry.author;
    }
    return member;
  }
  const RosterEntry* entry(const Author& author) const {
    return follower_.entry_of(author.incarnation);
  }
  /// Steps of `whose` coverage that `who` holds, by its newest digest; 0 if it holds nothing.
  std::int64_t held(const Author& who, const Author& whose) const {
    const auto digest = held_.find({who, whose});
    return digest == held_.end() ? 0 : digest->second;
  }
  /// The newest block `at` received of `author`, from any transmitter; steps 0 if there is none.
  Contribution block(const Author& author, int at = 0) const {
    const auto block = blocks_.find({author, at});
    return block == blocks_.end() ? Contribution{} : block->second;
  }
  /// Steps of the oldest of its blocks, one or two: what a digest calls held.
  std::int64_t steps_sent(const Author& author) const {
    const std::int64_t first = block(author, 0).steps;
    return blocks_.contains({author, 1}) ? std::min(first, block(author, 1).steps) : first;
  }
  /// The last tick that `author` has answered; −1 if no message of it was received.
  Tick answered(const Author& author) const {
    const auto tick = answered_.find(author);
    return tick == answered_.end() ? -1 : tick->second;
  }
  /// The last tick that the logger has acknowledged; −1 if no acknowledgement was received.
  Tick recorded() const { return recorded_; }
  /// Whether the agent's last two statuses have the same tick: in lockstep, half a second without
  /// progress.
  bool stands_still(const Author& author) const {
    const auto ticks = status_ticks_.find(author);
    return ticks != status_ticks_.end() && ticks->second.first == ticks->second.second;
  }

 private:
  void receive(const Message& message) {
    const Author author{header_of(message).sender, header_of(message).incarnation};
    if (const auto* part = std::get_if<MissionPart>(&message)) follower_.receive(*part);
    if (const auto* ack = std::get_if<RecordAck>(&message)) recorded_ = ack->header.tick;
    if (std::holds_alternative<AgentStatus>(message)) {
      auto& [before_last, last] = status_ticks_.try_emplace(author, -2, -1).first->second;
      before_last = std::exchange(last, header_of(message).tick);
    }
    if (const auto* command = std::get_if<Command>(&message)) {
      answered_[author] = std::max(answered(author), command->header.tick);
    }
    if (const auto* digest = std::get_if<Digest>(&message)) {
      for (int i = 0; i < digest->entry_count; ++i) {
        const DigestEntry& entry = digest->entries[static_cast<std::size_t>(i)];
        held_[{author, entry.author}] = entry.steps;
      }
    }
    const auto* newer = std::get_if<Contribution>(&message);
    if (newer != nullptr && newer->steps > block(author, newer->block).steps) {
      blocks_[{author, newer->block}] = *newer;
    }
  }

  std::unique_ptr<Transport> transport_;
  MissionFollower follower_;
  std::map<Author, std::pair<Tick, Tick>> status_ticks_;  // of the last two statuses
  std::map<std::pair<Author, int>, Contribution> blocks_;
  std::map<Author, Tick> answered_;
  Tick recorded_ = -1;
  std::map<std::pair<Author, Author>, std::int64_t> held_;
};

}  // namespace ergocast::test
