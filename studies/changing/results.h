// SPDX-License-Identifier: BSD-3-Clause
// The figures of all seeds by case, as a table for a document and as a CSV file.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "report/statistics.h"

namespace ergocast::studies {

/// A case: what differs between missions, then what was measured.
using CaseName = std::pair<std::string, std::string>;

class Results {
 public:
  void add(const CaseName& name, double metric) { metrics_[name].push_back(metric); }

  /// The geometric mean over the seeds, with its confidence interval.
  Estimate mean(const CaseName& name) const;
  /// Seed by seed, the geometric mean of the ratio of two cases.
  Estimate ratio(const CaseName& of, const CaseName& to) const;

  /// Writes one line a case and seed.
  void write(const std::filesystem::path& file) const;

 private:
  std::map<CaseName, std::vector<double>> metrics_;  // by seed
};

/// "value (low to high)"
std::string to_string(const Estimate& estimate);

}  // namespace ergocast::studies
