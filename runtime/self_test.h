// SPDX-License-Identifier: BSD-3-Clause
// Whether this process can hear what it sends on a bus.
#pragma once

#include <optional>
#include <string>

#include "runtime/lcm_url.h"
#include "team/messages.h"

namespace ergocast {

/// Sends a datagram to the bus, which does not leave this host and which LCM's programs discard by
/// its first bytes.
/// @return nothing as soon as it comes back; otherwise the cause with its remedy, after at most 10
/// s
std::optional<std::string> why_deaf(const LcmUrl& url, Bus bus);

}  // namespace ergocast
