// SPDX-License-Identifier: BSD-3-Clause
// Encodes bytes as text.
#pragma once

#include <string>
#include <string_view>

namespace ergocast {

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

}  // namespace ergocast
