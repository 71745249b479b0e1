// SPDX-License-Identifier: BSD-3-Clause
// Does multicast leave over the interface that is meant?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "ops/doctor/finding.h"
#include "ops/doctor/interfaces.h"
#include "runtime/lcm_url.h"

namespace ergocast::doctor {

/// The longest IP packet of ours: a message of 1220 bytes under LCM's header and channel name.
inline constexpr int kLongestPacketBytes = 1280;

/// Route, interface and MTU.
/// @param routed  the interface that the group's route names, if there is a route
Findings routing_findings(const LcmUrl& url, const std::optional<std::string>& routed,
                          const std::vector<Interface>& all);

/// @param several_hosts  whether somebody else is meant to hear us
Finding ttl_finding(const LcmUrl& url, bool several_hosts);

/// @param failure    why a datagram to the group did not come back, if it did not
/// @param has_route  whether there is a route to the group; if not, that says it all
Finding self_test_finding(const LcmUrl& url, const std::optional<std::string>& failure,
                          bool has_route);

}  // namespace ergocast::doctor
