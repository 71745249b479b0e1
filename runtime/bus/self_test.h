// SPDX-License-Identifier: BSD-3-Clause
// Whether this process receives what it sends on a bus.
#pragma once

#include <optional>
#include <string>

#include "runtime/bus/lcm_url.h"
#include "team/messages.h"

namespace ergocast {

/// Sends a datagram to the bus. It does not leave this host, and LCM's programs discard it by its
/// first bytes.
/// @return nothing as soon as it comes back; else, after at most 10 s, the cause with its remedy
std::optional<std::string> why_deaf(const LcmUrl& url, Bus bus);

}  // namespace ergocast
