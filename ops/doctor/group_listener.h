// SPDX-License-Identifier: BSD-3-Clause
// A socket that listens to a group beside LCM's.
#pragma once

#include <string>

#include "runtime/socket.h"

namespace ergocast::doctor {

/// Hears what is sent to the group and port, and no other group's; shares the port as LCM does.
/// Its fd() is valid even if `error` says why it hears nothing.
Socket group_listener(const std::string& group, int port, std::string& error);

}  // namespace ergocast::doctor
