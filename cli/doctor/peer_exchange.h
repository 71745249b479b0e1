// SPDX-License-Identifier: BSD-3-Clause
// Exchanges probes with other hosts and reports which hosts receive which.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "cli/doctor/finding.h"
#include "cli/doctor/peer_ledger.h"
#include "lcmtypes/message_authenticator.h"
#include "runtime/bus/lcm_url.h"

namespace ergocast::doctor {

struct PeerTest {
  std::vector<Peer> peers;
  int only_received_by_others = 0;
  std::uint32_t sent = 0;
  std::string error;  ///< why the test failed; empty: it succeeded
};

/// Sends kProbesPerSecond for `duration`. @pre at most kMaxPeerSeconds
PeerTest try_peers(const LcmUrl& url, const MessageAuthenticator& authenticator,
                   std::chrono::seconds duration);

/// One finding for each peer, or one if no peer was received.
/// @param version  ours
/// @param key  the fingerprint of ours
Findings peer_findings(const LcmUrl& url, const PeerTest& test, const std::string& version,
                       std::uint64_t key = 0);

}  // namespace ergocast::doctor
