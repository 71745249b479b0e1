// SPDX-License-Identifier: BSD-3-Clause
// Several agents driven together: each receives the others' messages on the swarm bus at once, if
// in range.
#pragma once

#include <functional>
#include <iterator>
#include <map>
#include <utility>

#include "tests/agent/driven_agent.h"

namespace ergocast::test {

using Receives = std::function<bool(AgentId listener, AgentId transmitter)>;

class LiveTeam {
 public:
  /// Makes every planned agent, with a running mission. All receive all until a test changes it.
  explicit LiveTeam(const Mission& mission) {
    for (AgentId id = 0; id < static_cast<AgentId>(mission.starts_m.size()); ++id) {
      agents_.emplace(id, running_agent(mission, id));
    }
  }

  Agent& operator[](AgentId id) { return agents_.at(id); }
  void set_receives(Receives receives) { receives_ = std::move(receives); }
  void kill(AgentId id) { agents_.erase(id); }
  /// Adds another incarnation of an agent that was killed.
  void revive(AgentId id, Agent agent) { agents_.emplace(id, std::move(agent)); }

  /// The world or the coordinator sends a message to all agents; returns all that follow from it.
  Outbox deliver(const Message& message, Instant now) {
    for (auto& [id, agent] : agents_) give(agent, message, now);
    return settle(now);
  }

  /// All agents send and receive until none has more to send at `now`; returns the messages.
  Outbox settle(Instant now) {
    Outbox sent;
    for (std::size_t before = std::size_t(-1); before != sent.size();) {
      before = sent.size();
      for (auto& [id, agent] : agents_) {
        Outbox words = advance(agent, now);
        for (const Outgoing& word : words) carry(word, id, now);
        std::move(words.begin(), words.end(), std::back_inserter(sent));
      }
    }
    return sent;
  }

  /// Lets time pass without a message from outside; returns the messages.
  Outbox wait(Instant from, std::chrono::nanoseconds duration) {
    Outbox sent;
    for (Instant now = from; now <= from + duration; now += 10ms) {
      Outbox words = settle(now);
      std::move(words.begin(), words.end(), std::back_inserter(sent));
    }
    return sent;
  }

 private:
  void carry(const Outgoing& word, AgentId transmitter, Instant now) {
    if (word.bus != Bus::kSwarm) return;
    for (auto& [id, agent] : agents_) {
      if (id != transmitter && receives_(id, transmitter)) {
        give(agent, word.message, now, transmitter);
      }
    }
  }

  std::map<AgentId, Agent> agents_;
  Receives receives_ = [](AgentId, AgentId) { return true; };
};

}  // namespace ergocast::test
