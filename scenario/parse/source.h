// SPDX-License-Identifier: BSD-3-Clause
// What a scenario is read from: a file, and values from the command line that replace its own.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/mission/mission.h"

namespace ergocast {

/// Limit (Scenario): length of a scenario file [bytes]. Beyond it: the command refuses it.
inline constexpr std::size_t kMaxScenarioBytes = std::size_t{1} << 20;

/// A number, word or truth value for the field at `path`, such as "law.epsilon" or
/// "agents.starts[0].x_m", as the text format writes it.
struct FieldValue {
  std::string path, value;
  std::string flag;  ///< the name of its source in problems
};

/// Values from the command line that replace those of the file.
struct Overrides {
  std::optional<std::uint64_t> seed{};
  std::optional<double> duration_s{};
  std::optional<Pace> pace{};
  std::optional<double> realtime_factor{};
  /// The team's size: the listed starts are cut, or random ones added.
  std::optional<int> agents{};
  /// Applied in this order, after all others.
  std::vector<FieldValue> fields{};
};

}  // namespace ergocast
