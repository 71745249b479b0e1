// SPDX-License-Identifier: BSD-3-Clause
// Whether this program takes bytes as a plan: the mission that they hold, or what is wrong.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include "plan/plan.h"

namespace ergocast::test {

/// The mission in a plan, if there is one.
inline std::optional<Mission> decoded(std::span<const std::byte> plan) {
  auto read = decode_plan(plan);
  return read ? std::optional(*std::move(read)) : std::nullopt;
}
inline bool is_taken(const Mission& mission) { return decoded(encode_plan(mission)).has_value(); }

inline std::string problem_of(std::span<const std::byte> plan) {
  const auto read = decode_plan(plan);
  return read ? "nothing" : read.error();
}
inline bool has(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

}  // namespace ergocast::test
