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
inline const std::string kLaw = "law {", kTime = "duration_s: 60", kUniform = "uniform_weight: 1";

/// One mistake put into kGood, and the beginning of its error text; the line is that of `from`.
struct Mistake {
  std::string from, to, said;
  bool has_line = true;
};

std::vector<Mistake> scenario_mistakes();
/// Those of the target and its files, which scenario_mistakes() has, too.
std::vector<Mistake> target_mistakes();
/// One mistake in a scenario of a box, which replaces kGood.
Mistake in_space(const std::string& from, const std::string& to, const std::string& said);

/// A target with one polygon. @param corners  x and y of each in turn
std::string polygon(const std::string& corners, const std::string& more = "");
std::string hole(const std::string& corners);
/// The corners alone, as a wall's or keep-out's fields.
std::string corners(const std::string& numbers);
/// A wall as a scenario's `world` has it. @param numbers  x and y of its corners in turn
std::string wall(const std::string& numbers, const std::string& more = "");

inline std::string repeated(int count, const std::string& text) {
  std::string all;
  for (int i = 0; i < count; ++i) all += text;
  return all;
}

}  // namespace ergocast::test
