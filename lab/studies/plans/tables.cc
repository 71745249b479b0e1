// SPDX-License-Identifier: BSD-3-Clause
// The tables of docs/announced_plans.md, from what lab/studies/plans/run has flown.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "lab/studies/table.h"
#include "report/statistics.h"

namespace ergocast::studies {
namespace {

namespace fs = std::filesystem;

struct Flights {
  std::vector<double> seeds, metrics;
};

Flights flights_of(const fs::path& file) {
  const Table table = read_table(file);
  return {table.at("seed"), table.at("ergodic_metric")};
}

/// Geometric mean · worst.
std::string spread(const std::vector<double>& metrics) {
  double logs = 0;
  for (const double metric : metrics) logs += std::log(metric);
  char text[64];
  std::snprintf(text, sizeof text, "%.2e · %.1e",
                std::exp(logs / static_cast<double>(metrics.size())),
                *std::max_element(metrics.begin(), metrics.end()));
  return text;
}

/// One line: the plans against the law, over the seeds that both flew.
void print_row(const fs::path& folder, const std::string& setting, const std::string& row) {
  Flights law = flights_of(folder / ("law-" + row + ".csv"));
  const Flights plans = flights_of(folder / (setting + "-" + row + ".csv"));
  const std::size_t runs = std::min(law.seeds.size(), plans.seeds.size());
  if (!std::equal(law.seeds.begin(), law.seeds.begin() + static_cast<std::ptrdiff_t>(runs),
                  plans.seeds.begin())) {
    throw std::runtime_error("other seeds of " + row + " under " + setting);
  }
  const auto first = [runs](std::vector<double> values) {
    values.resize(runs);
    return values;
  };
  const std::vector<double> theirs = first(law.metrics), ours = first(plans.metrics);
  const Estimate ratio = ratio_of(ours, theirs);
  const double worst =
      *std::max_element(ours.begin(), ours.end()) / *std::max_element(theirs.begin(), theirs.end());
  std::printf("| %s | %zu | %s | %s | %.3g (%.3g to %.3g) | %.2g |\n", row.c_str(), runs,
              spread(theirs).c_str(), spread(ours).c_str(), ratio.value, ratio.low, ratio.high,
              worst);
}

}  // namespace
}  // namespace ergocast::studies

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: studies-plans FOLDER SETTING ROW...\n");
    return 2;
  }
  try {
    std::printf(
        "%s:\n\n| | runs | the law: mean · worst | plans: mean · worst | ratio of means | ratio of "
        "worst cases |\n|---|---|---|---|---|---|\n",
        argv[2]);
    for (int row = 3; row < argc; ++row) ergocast::studies::print_row(argv[1], argv[2], argv[row]);
    std::printf("\n");
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "studies-plans: %s\n", error.what());
    return 2;
  }
}
