// SPDX-License-Identifier: BSD-3-Clause
// Sends probes, listens for others', and says who hears whom.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "ops/doctor/finding.h"
#include "ops/doctor/peer_ledger.h"
#include "lcmtypes/seal.h"
#include "runtime/lcm_url.h"

namespace ergocast::doctor {

struct PeerTest {
  std::vector<Peer> peers;
  int only_heard_by_others = 0;
  std::uint32_t sent = 0;
  std::string error;  ///< why it could not be done; empty: it was
};

/// For so long, with kProbesPerSecond. @pre at most kMaxPeerSeconds
PeerTest try_peers(const LcmUrl& url, const Seal& seal, std::chrono::seconds duration);

/// One finding for each peer, or one that nobody was heard.
/// @param version  ours
/// @param key  the fingerprint of ours
Findings peer_findings(const LcmUrl& url, const PeerTest& test, const std::string& version,
                       std::uint64_t key = 0);

}  // namespace ergocast::doctor
