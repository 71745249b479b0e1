// SPDX-License-Identifier: BSD-3-Clause
// The network interface that the kernel uses for a multicast group.
#pragma once

#include <netinet/in.h>

namespace ergocast {

/// The index of the interface that `ip route get` prints; 0: there is no route.
unsigned interface_towards(in_addr group);

}  // namespace ergocast
