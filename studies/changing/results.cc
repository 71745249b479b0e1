// SPDX-License-Identifier: BSD-3-Clause
// Means by seed, and the file.
#include "studies/changing/results.h"

#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace ergocast::studies {

Estimate Results::mean(const CaseName& name) const {
  const std::vector<double>& metrics = metrics_.at(name);
  return ratio_of(metrics, std::vector<double>(metrics.size(), 1.0));
}

Estimate Results::ratio(const CaseName& of, const CaseName& to) const {
  return ratio_of(metrics_.at(of), metrics_.at(to));
}

void Results::write(const std::filesystem::path& file) const {
  std::ofstream out(file);
  out << "case,measured,seed,ergodic_metric\n";
  for (const auto& [name, metrics] : metrics_) {
    for (std::size_t i = 0; i < metrics.size(); ++i)
      out << name.first << ',' << name.second << ',' << i + 1 << ',' << metrics[i] << '\n';
  }
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

std::string to_string(const Estimate& estimate) {
  char text[80];
  std::snprintf(text, sizeof text, "%.2e (%.1e to %.1e)", estimate.value, estimate.low,
                estimate.high);
  return text;
}

}  // namespace ergocast::studies
