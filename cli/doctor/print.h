// SPDX-License-Identifier: BSD-3-Clause
// Findings and peers as text for people and as JSON for programs.
#pragma once

#include <string>

#include "cli/doctor/finding.h"
#include "cli/doctor/peer_exchange.h"
#include "runtime/bus/lcm_url.h"

namespace ergocast::doctor {

struct Look {
  bool coloured = false;
  int columns = 100;  ///< width at which explanations are wrapped
};

/// The findings as text, the worst first.
std::string text_of(const LcmUrl& url, Findings findings, const Look& look);
/// A table with one line for each peer; empty without peers.
std::string text_of(const std::vector<Peer>& peers);

/// {"url", "host", "findings": […], "peers": […]}.
std::string json_of(const LcmUrl& url, const Findings& findings, const std::vector<Peer>& peers);

}  // namespace ergocast::doctor
