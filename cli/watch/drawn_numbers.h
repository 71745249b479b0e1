// SPDX-License-Identifier: BSD-3-Clause
// Reads the lists of numbers that a drawing on the page consists of.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

namespace ergocast::cli {

/// A list of N finite numbers; nothing if it is none.
template <std::size_t N>
std::optional<std::array<double, N>> drawn_numbers(const nlohmann::json& list) {
  if (!list.is_array() || list.size() != N) return std::nullopt;
  std::array<double, N> values{};
  for (std::size_t i = 0; i < N; ++i) {
    if (!list[i].is_number()) return std::nullopt;
    values[i] = list[i].get<double>();
    if (!std::isfinite(values[i])) return std::nullopt;
  }
  return values;
}

/// The corners of a polygon, at least three; nothing if the list has another form.
inline std::optional<std::vector<std::array<double, 2>>> drawn_corners(const nlohmann::json& list) {
  if (!list.is_array() || list.size() < 3) return std::nullopt;
  std::vector<std::array<double, 2>> read;
  for (const nlohmann::json& one : list) {
    const auto corner = drawn_numbers<2>(one);
    if (!corner) return std::nullopt;
    read.push_back(*corner);
  }
  return read;
}

}  // namespace ergocast::cli
