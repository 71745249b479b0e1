// SPDX-License-Identifier: BSD-3-Clause
// Makes a socket the receiver of one multicast group at one port.
#pragma once

#include <optional>
#include <string>

#include "runtime/bus/socket.h"

namespace ergocast {

/// From now on `socket` receives the datagrams to this group and port, on the interface that the
/// route names. It receives no others: neither those to another group at the same port nor those to
/// an address of this host. Other sockets may share the port, LCM's included.
/// @return nothing, or why it cannot
std::optional<std::string> listen_to_group(const Socket& socket, const std::string& group,
                                           int port);

}  // namespace ergocast
