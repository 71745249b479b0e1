// SPDX-License-Identifier: BSD-3-Clause
// Is a run on the swarm bus? Only listens: nothing that it does reaches a team.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "team/messages.h"
#include "ops/doctor/finding.h"
#include "lcmtypes/seal.h"
#include "runtime/lcm_url.h"

namespace ergocast::doctor {

/// What was overheard of one run.
struct HeardRun {
  std::int64_t messages = 0;
  std::set<AgentId> agents;
  std::set<std::string> hosts, versions;
  std::string state;  ///< of the mission; empty: not said
};

/// Takes in datagrams of the swarm bus. Nothing about them is trusted.
class Overheard {
 public:
  explicit Overheard(const Seal& seal = {}) : seal_(seal) {}

  void take(std::span<const std::byte> datagram);
  /// @param free_port  a base port that would be free, if one is known
  Finding finding(const LcmUrl& url, std::optional<int> free_port) const;
  bool anything() const { return !runs_.empty() || foreign_messages_ > 0 || other_key_ > 0 || unkeyed_ > 0; }

 private:
  void take(const Message& message);
  std::optional<Finding> key_finding() const;

  Seal seal_;
  std::map<RunId, HeardRun> runs_;
  std::int64_t other_key_ = 0, unkeyed_ = 0;  // ours by their look, but not opened by our seal
  std::int64_t foreign_messages_ = 0;  // LCM's, but not ours
  std::set<std::string> foreign_channels_;
};

/// Listens for so long. `error` says why nothing can be heard, if so.
Overheard listen_to_swarm(const LcmUrl& url, const Seal& seal, std::chrono::milliseconds duration,
                          std::string& error);

/// Whether messages are checked with a team's key.
Finding authentication_finding(bool keyed);

}  // namespace ergocast::doctor
