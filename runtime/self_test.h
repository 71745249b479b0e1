// SPDX-License-Identifier: BSD-3-Clause
// Whether this process can hear what it sends on a bus.
#pragma once

#include "runtime/lcm_url.h"
#include "team/messages.h"

namespace ergocast {

/// Sends a datagram to the bus, which does not leave this host and which LCM's programs discard by
/// its first bytes. True as soon as it comes back; false after 10 s, or if there is no socket.
bool hears_itself(const LcmUrl& url, Bus bus);

}  // namespace ergocast
