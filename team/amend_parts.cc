// SPDX-License-Identifier: BSD-3-Clause
// Takes one share after the other off the content.
#include "team/amend_parts.h"

#include <algorithm>
#include <cstdint>

namespace ergocast {

std::vector<Amend> in_parts(const Amend& amend, std::span<const std::byte> content) {
  constexpr auto kMost = static_cast<std::size_t>(kMaxPlanBytesPerMessage);
  std::vector<Amend> parts((content.size() + kMost - 1) / kMost, amend);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const auto share = content.first(std::min(kMost, content.size()));
    content = content.subspan(share.size());
    parts[p].header.sequence += static_cast<std::int64_t>(p);
    parts[p].part = static_cast<std::int32_t>(p);
    parts[p].parts = static_cast<std::int32_t>(parts.size());
    parts[p].content.assign(share.begin(), share.end());
  }
  return parts;
}

}  // namespace ergocast
