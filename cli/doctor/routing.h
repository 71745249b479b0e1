// SPDX-License-Identifier: BSD-3-Clause
// Checks whether multicast leaves over the intended interface.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/doctor/finding.h"
#include "cli/doctor/interfaces.h"
#include "runtime/bus/lcm_url.h"

namespace ergocast::doctor {

/// Our longest IP packet: a message of 1220 bytes with LCM's header and channel name.
inline constexpr int kLongestPacketBytes = 1280;

/// Checks route, interface and MTU.
/// @param routed  the interface that the group's route names, if there is a route
Findings routing_findings(const LcmUrl& url, const std::optional<std::string>& routed,
                          const std::vector<Interface>& all);

/// @param several_hosts  whether other hosts must receive our messages
Finding ttl_finding(const LcmUrl& url, bool several_hosts);

/// @param failure    why a datagram to the group did not come back; nothing if it did
/// @param has_route  whether there is a route to the group; without one the failure
///                   needs no other cause
Finding self_test_finding(const LcmUrl& url, const std::optional<std::string>& failure,
                          bool has_route);

}  // namespace ergocast::doctor
