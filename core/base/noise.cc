// SPDX-License-Identifier: BSD-3-Clause
// Runs Philox on (seed, purpose, who, step) as a counter, and turns its bits into uniform or
// normal pairs.
#include "core/base/noise.h"

#include <Random123/philox.h>

#include <cmath>
#include <numbers>

#include "core/base/portable_math.h"

namespace ergocast {
namespace {

/// The top 53 bits, moved off 0 by half a unit so that a logarithm is always finite.
double to_open_unit(std::uint64_t word) {
  return (static_cast<double>(word >> 11) + 0.5) * 0x1p-53;
}

/// The second pair of numbers of a step has a counter that no first pair has.
constexpr std::uint32_t kSecondPair = 0x8000'0000;

RandomBits words_at(std::uint64_t seed, std::uint32_t purpose, std::uint32_t who,
                    std::uint64_t step) {
  const r123::Philox4x32::ctr_type counter = {
      {static_cast<std::uint32_t>(step), static_cast<std::uint32_t>(step >> 32), who, purpose}};
  const r123::Philox4x32::key_type key = {
      {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)}};
  const auto word = r123::Philox4x32()(counter, key);
  return {static_cast<std::uint64_t>(word[0]) << 32 | word[1],
          static_cast<std::uint64_t>(word[2]) << 32 | word[3]};
}

Eigen::Vector2d uniform_of(const RandomBits& words) {
  return {to_open_unit(words.first), to_open_unit(words.second)};
}

Eigen::Vector2d second_uniform_pair(std::uint64_t seed, Purpose purpose, std::uint32_t who,
                                    std::uint64_t step) {
  return uniform_of(words_at(seed, static_cast<std::uint32_t>(purpose) | kSecondPair, who, step));
}

Eigen::Vector2d normal_of(const Eigen::Vector2d& u) {
  const double radius = std::sqrt(-2 * portable::log(u.x()));
  const portable::SinCos at = portable::sin_cos(2 * std::numbers::pi * u.y());
  return {radius * at.cos, radius * at.sin};
}

}  // namespace

RandomBits random_words(std::uint64_t seed, Purpose purpose, std::uint32_t who,
                        std::uint64_t step) {
  return words_at(seed, static_cast<std::uint32_t>(purpose), who, step);
}

Eigen::Vector2d uniform_pair(std::uint64_t seed, Purpose purpose, std::uint32_t who,
                             std::uint64_t step) {
  return uniform_of(random_words(seed, purpose, who, step));
}

Eigen::Vector2d normal_pair(std::uint64_t seed, Purpose purpose, std::uint32_t who,
                            std::uint64_t step) {
  return normal_of(uniform_pair(seed, purpose, who, step));
}

Eigen::Vector3d uniform_in(const Box& domain, std::uint64_t seed, Purpose purpose,
                           std::uint32_t who, std::uint64_t step) {
  Eigen::Vector3d share(0, 0, 0);
  share.head<2>() = uniform_pair(seed, purpose, who, step);
  if (!domain.planar()) share.z() = second_uniform_pair(seed, purpose, who, step).x();
  return domain.origin_m + share.cwiseProduct(domain.size_m);
}

Eigen::Vector3d normal_in(const Box& domain, std::uint64_t seed, Purpose purpose, std::uint32_t who,
                          std::uint64_t step) {
  const Eigen::Vector2d pair = normal_pair(seed, purpose, who, step);
  if (domain.planar()) return {pair.x(), pair.y(), 0};
  return {pair.x(), pair.y(), normal_of(second_uniform_pair(seed, purpose, who, step)).x()};
}

}  // namespace ergocast
