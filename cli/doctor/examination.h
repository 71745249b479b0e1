// SPDX-License-Identifier: BSD-3-Clause
// Runs all checks of this host, in order. Changes nothing on it.
#pragma once

#include "cli/doctor/finding.h"
#include "lcmtypes/message_authenticator.h"
#include "runtime/bus/lcm_url.h"

namespace ergocast::doctor {

struct Examination {
  Findings findings;
  bool lcm_usable = false;
  /// Why no probes may be sent to the swarm's port, which another program uses; empty: it is free.
  std::string port_taken;
};

/// @param authenticator  the team's, if it has a key
/// @param several_hosts  whether the team uses other hosts, too
Examination examine(const LcmUrl& url, const MessageAuthenticator& authenticator,
                    bool several_hosts);

}  // namespace ergocast::doctor
