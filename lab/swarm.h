// SPDX-License-Identifier: BSD-3-Clause
// The whole swarm in one process: the same cores and the same codec as over LCM, in virtual time.
//
// Messages travel as bytes and arrive in the order they were sent; a filter may drop them. When
// nothing is in flight, time jumps to the next wake-up of anybody.
#pragma once

#include <deque>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "agent/agent.h"
#include "coordinator/coordinator.h"
#include "team/messages.h"
#include "team/mission_follower.h"
#include "logger/recorder.h"
#include "sim/world.h"

namespace ergocast::lab {

/// Who takes part: agents by number, then the others.
inline constexpr int kWorldSeat = -3, kCoordinatorSeat = -2, kLoggerSeat = -4;

struct Options {
  std::vector<std::byte> plan;  ///< compiled
  int agents = 0;
  std::string host = "laboratory";
  std::string version;
  /// Whether this message reaches that node; all do if empty.
  std::function<bool(const Message&, int node)> delivers;
};

class Swarm {
 public:
  /// @pre options.plan decodes.
  Swarm(Options options, std::ostream& trajectory, std::ostream& metrics);

  /// Delivers what is in flight and lets everybody answer; with nothing in flight, time first jumps
  /// to the next wake-up. False once all is over.
  bool step();
  /// Runs until the mission is over, or `limit` of virtual time has passed.
  void run(std::chrono::nanoseconds limit = std::chrono::hours(24 * 365));

  Instant now() const { return now_; }
  Agent& agent(int i) { return *agents_[static_cast<std::size_t>(i)]; }
  const World& world() const { return world_; }
  const Coordinator& coordinator() const { return coordinator_; }
  Coordinator& coordinator() { return coordinator_; }
  const Recorder& recorder() const { return recorder_; }
  std::int64_t messages_sent() const { return messages_sent_; }
  std::int64_t messages_dropped() const { return messages_dropped_; }

 private:
  struct Datagram {
    Bus bus;
    AgentId transmitter;
    std::vector<std::byte> bytes;
  };

  void pass_time();
  void advance_all();
  void send(Outbox& out);
  void deliver(const Datagram& datagram);
  bool reaches(const Message& message, int node);
  bool everybody_finished() const;
  Instant next_wakeup() const;

  Options options_;
  RunId run_;
  std::vector<std::unique_ptr<Agent>> agents_;
  World world_;
  Coordinator coordinator_;
  Recorder recorder_;
  Instant now_{};
  bool started_ = false;
  std::deque<Datagram> in_flight_;
  std::vector<std::vector<std::byte>> spare_;  // buffers to use again
  Outbox outbox_;
  std::int64_t messages_sent_ = 0, messages_dropped_ = 0;
};

}  // namespace ergocast::lab
