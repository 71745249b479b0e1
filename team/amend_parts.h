// SPDX-License-Identifier: BSD-3-Clause
// Divides an AMEND with a large content into the parts that fit into messages.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "team/messages.h"

namespace ergocast {

/// The messages of one AMEND with this content, of at most kMaxPlanBytesPerMessage bytes each.
/// @param amend  all but part, parts and content. The first message has the sequence number of its
///               header, and each further one the next number.
/// @pre content needs at most kMaxAmendParts parts
std::vector<Amend> in_parts(const Amend& amend, std::span<const std::byte> content);

}  // namespace ergocast
