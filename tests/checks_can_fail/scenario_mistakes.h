// SPDX-License-Identifier: BSD-3-Clause
// A good scenario, and the mistakes that people make in one, each with its error text.
#pragma once

#include <string>
#include <vector>

namespace ergocast::test {

inline const std::string kGood = R"(domain { size_x_m: 100 size_y_m: 50 }
target { uniform_weight: 1 }
law { u_max_mps: 5 }
time { duration_s: 60 }
agents { starts { x_m: 10 y_m: 20 } }
)";

/// Places in it.
inline const std::string kLaw = "law {", kTime = "duration_s: 60";

/// One mistake put into kGood, and the beginning of its error text; the line is that of `from`.
struct Mistake {
  std::string from, to, said;
  bool has_line = true;
};

std::vector<Mistake> scenario_mistakes();

/// A wall as a scenario's `world` has it. @param numbers  x and y of its corners in turn
std::string wall(const std::string& numbers, const std::string& more = "");

inline std::string repeated(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

}  // namespace ergocast::test
