// SPDX-License-Identifier: BSD-3-Clause
// Runs Philox on (seed, purpose, who, step) as a counter, and turns its bits into uniform or
// normal pairs.
#include "core/noise.h"

#include <Random123/philox.h>

#include <cmath>
#include <numbers>

namespace ergocast {
namespace {

/// The top 53 bits, moved off 0 by half a unit so that a logarithm is always finite.
double to_open_unit(std::uint64_t word) { return (static_cast<double>(word >> 11) + 0.5) * 0x1p-53; }

}  // namespace

RandomBits random_words(std::uint64_t seed, Purpose purpose, std::uint32_t who,
                        std::uint64_t step) {
  const r123::Philox4x32::ctr_type counter = {{static_cast<std::uint32_t>(step),
                                               static_cast<std::uint32_t>(step >> 32), who,
                                               static_cast<std::uint32_t>(purpose)}};
  const r123::Philox4x32::key_type key = {
      {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}};
  const auto word = r123::Philox4x32()(counter, key);
  return {static_cast<std::uint64_t>(word[0]) << 32 | word[1],
          static_cast<std::uint64_t>(word[2]) << 32 | word[3]};
}

Eigen::Vector2d uniform_pair(std::uint64_t seed, Purpose purpose, std::uint32_t who,
                             std::uint64_t step) {
  const RandomBits words = random_words(seed, purpose, who, step);
  return {to_open_unit(words.first), to_open_unit(words.second)};
}

Eigen::Vector2d normal_pair(std::uint64_t seed, Purpose purpose, std::uint32_t who,
                            std::uint64_t step) {
  const Eigen::Vector2d u = uniform_pair(seed, purpose, who, step);
  const double radius = std::sqrt(-2 * std::log(u.x()));
  const double angle = 2 * std::numbers::pi * u.y();
  return {radius * std::cos(angle), radius * std::sin(angle)};
}

}  // namespace ergocast
