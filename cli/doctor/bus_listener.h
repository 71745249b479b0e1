// SPDX-License-Identifier: BSD-3-Clause
// Detects runs on the swarm bus. It only listens and sends nothing to a team.
#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>

#include "cli/doctor/finding.h"
#include "lcmtypes/message_authenticator.h"
#include "runtime/bus/lcm_url.h"
#include "team/messages.h"

namespace ergocast::doctor {

/// The messages received of one run.
struct HeardRun {
  std::int64_t messages = 0;
  std::set<AgentId> agents;
  std::set<std::string> hosts, versions;
  std::string state;  ///< of the mission; empty: not received
};

/// Counts datagrams of the swarm bus. It does not trust their content.
class Overheard {
 public:
  explicit Overheard(const MessageAuthenticator& authenticator = {})
      : authenticator_(authenticator) {}

  void take(std::span<const std::byte> datagram);
  /// @param free_port  a free base port, if one is known
  Finding finding(const LcmUrl& url, std::optional<int> free_port) const;
  bool anything() const {
    return !runs_.empty() || foreign_messages_ > 0 || other_key_ > 0 || unkeyed_ > 0;
  }

 private:
  void take(const Message& message);
  std::optional<Finding> key_finding() const;

  MessageAuthenticator authenticator_;
  std::map<RunId, HeardRun> runs_;
  std::int64_t other_key_ = 0, unkeyed_ = 0;  // ours by their format, but refused by our key
  std::int64_t foreign_messages_ = 0;         // LCM's, but not of Ergocast
  std::set<std::string> foreign_channels_;
};

/// Listens for `duration`. If nothing can be received, `error` gets the reason.
Overheard listen_to_swarm(const LcmUrl& url, const MessageAuthenticator& authenticator,
                          std::chrono::milliseconds duration, std::string& error);

/// Reports whether messages are checked with a team's key.
Finding authentication_finding(bool keyed);

}  // namespace ergocast::doctor
