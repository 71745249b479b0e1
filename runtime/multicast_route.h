// SPDX-License-Identifier: BSD-3-Clause
// Over which network interface the kernel sends to a multicast group.
#pragma once

#include <netinet/in.h>

namespace ergocast {

/// The index of the interface that `ip route get` would name; 0: there is no route.
unsigned interface_towards(in_addr group);

}  // namespace ergocast
