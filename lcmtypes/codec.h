// SPDX-License-Identifier: BSD-3-Clause
// Encodes plain messages to protected bytes and decodes them: the only code that knows the wire
// format.
//
// Checks are made in this order: size, type, tag (a hash over everything), run, signature, then
// field by field (lcmtypes/fields.h). The decoders of lcm-gen are not used, because they trust a
// declared count before they check the length.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "core/base/result.h"
#include "lcmtypes/message_authenticator.h"
#include "team/messages.h"

namespace ergocast {

/// Writes `message` into `out`, whose capacity is reused. Strings are cut at their limits.
/// @param channel  on which it will be published; only a keyed tag covers it
/// @pre counts within the limits of team/messages.h.
void encode(const Message& message, std::vector<std::byte>& out,
            const MessageAuthenticator& authenticator = {}, std::string_view channel = {});

/// A message, or why its bytes are refused.
using Decoded = Result<Message, Refusal>;

/// The message in `bytes`, or why it is refused. Never throws, whatever the bytes are.
/// @param run  the only run accepted; 0 accepts any (for monitors and processes that have not
///             joined)
/// @param channel  on which it arrived; only a keyed tag covers it
/// @param known  signatures that need not be checked again; may be null
Decoded decode(std::span<const std::byte> bytes, RunId run,
               const MessageAuthenticator& authenticator = {}, std::string_view channel = {},
               KnownSignatures* known = nullptr) noexcept;

}  // namespace ergocast
