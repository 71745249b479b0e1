// SPDX-License-Identifier: BSD-3-Clause
// Asks a hub for the state of its sites.
#pragma once

#include <string>

#include "core/base/result.h"
#include "lcmtypes/message_authenticator.h"
#include "relay/endpoint.h"

namespace ergocast::relay {

/// The hub's report, or why there is none. Waits at most three seconds, and for the name server.
Result<std::string> ask_hub(const HostAndPort& hub, const MessageAuthenticator& authenticator);

}  // namespace ergocast::relay
