// SPDX-License-Identifier: BSD-3-Clause
// Compares values with their ranges, and skips fields that already have a problem.
#include "scenario/rules/checks.h"

#include <cmath>
#include <utility>

namespace ergocast {

std::string indexed(const std::string& path, int index) {
  return path + "[" + std::to_string(index) + "]";
}

double rounded_up(double value) {
  if (!(value > 0)) return 0;
  const double scale = std::pow(10, 3 - std::floor(std::log10(value)));
  return std::ceil(value * scale) / scale;
}

double rounded_down(double value) {
  if (!(value > 0)) return 0;
  const double scale = std::pow(10, 3 - std::floor(std::log10(value)));
  return std::floor(value * scale) / scale;
}

void Checks::problem(const std::string& path, const std::string& what, std::string remedy) {
  unsound_.insert(path);
  findings_.add(path, what, std::move(remedy));
}

void Checks::of_a_box_alone(const std::string& path) {
  problem(path, "the domain is a plane", "remove it, or add size_z_m to the domain");
}

bool Checks::sound(const std::string& path) const {
  const auto next = unsound_.lower_bound(path);
  return next == unsound_.end() || !next->starts_with(path);
}

void Checks::missing(const std::string& path, const std::string& what, std::string remedy) {
  if (!sound(path)) return;
  for (const std::string& lost : findings_.given_up()) {
    if (path.starts_with(lost + ".")) return;
  }
  for (const std::string& meant : findings_.excused()) {
    if (path != meant && !path.starts_with(meant + ".")) continue;
    unsound_.insert(path);
    return;
  }
  problem(path, what, std::move(remedy));
}

bool Checks::in_range(const std::string& path, double value, const Range& range,
                      const std::string& wanted) {
  if (range.contains(value)) return true;
  std::string what = shortest(value);
  if (std::isnan(value)) {
    what = "nan is not a number";
  } else if (!wanted.empty()) {
    what += " is far outside the domain";
  } else if (value > range.high) {
    what += " is above the limit " + shortest(range.high);
  } else if (range.low_excluded) {
    what += " is not above " + shortest(range.low);
  } else {
    what += " is below the limit " + shortest(range.low);
  }
  problem(path, what, "write a number " + (wanted.empty() ? range.text() : wanted));
  return false;
}

}  // namespace ergocast
