// SPDX-License-Identifier: BSD-3-Clause
// A socket that receives the datagrams of a multicast group, in addition to the team's.
#pragma once

#include <string>

#include "runtime/bus/socket.h"

namespace ergocast::doctor {

/// Receives datagrams to this group and port only (runtime/bus/group_socket.h). Its fd() is valid
/// even if it receives nothing; `error` then has the reason.
Socket group_listener(const std::string& group, int port, std::string& error);

}  // namespace ergocast::doctor
