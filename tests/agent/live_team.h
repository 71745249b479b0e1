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

using Hears = std::function<bool(AgentId listener, AgentId transmitter)>;

class LiveTeam {
 public:
  /// Every planned agent, with a running mission; all receive all until a test changes it.
  explicit LiveTeam(const Mission& mission) {
    for (AgentId id = 0; id < static_cast<AgentId>(mission.starts_m.size()); ++id) {
      agents_.emplace(id, running_agent(mission, id));
    }
  }

  Agent& operator[](AgentId id) { return agents_.at(id); }
  void hear_by(Hears hears) { hears_ = std::move(hears); }
  void kill(AgentId id) { agents_.erase(id); }
  /// Another incarnation of an agent that was killed.
  void revive(AgentId id, Agent agent) { agents_.emplace(id, std::move(agent)); }

  /// The world or the coordinator sends a message to all agents; returns all that follow from it.
  Outbox tell(const Message& message, Instant now) {
    for (auto& [id, agent] : agents_) give(agent, message, now);
    return settle(now);
  }

  /// All agents send and receive until none has more to send at `now`; returns the messages.
  Outbox settle(Instant now) {
    Outbox said;
    for (std::size_t before = std::size_t(-1); before != said.size();) {
      before = said.size();
      for (auto& [id, agent] : agents_) {
        Outbox words = advance(agent, now);
        for (const Outgoing& word : words) carry(word, id, now);
        std::move(words.begin(), words.end(), std::back_inserter(said));
      }
    }
    return said;
  }

  /// Time passes and nothing comes from outside; returns the messages.
  Outbox wait(Instant from, std::chrono::nanoseconds duration) {
    Outbox said;
    for (Instant now = from; now <= from + duration; now += 10ms) {
      Outbox words = settle(now);
      std::move(words.begin(), words.end(), std::back_inserter(said));
    }
    return said;
  }

 private:
  void carry(const Outgoing& word, AgentId transmitter, Instant now) {
    if (word.bus != Bus::kSwarm) return;
    for (auto& [id, agent] : agents_) {
      if (id != transmitter && hears_(id, transmitter)) {
        give(agent, word.message, now, transmitter);
      }
    }
  }

  std::map<AgentId, Agent> agents_;
  Hears hears_ = [](AgentId, AgentId) { return true; };
};

}  // namespace ergocast::test
