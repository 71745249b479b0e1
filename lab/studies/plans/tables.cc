// SPDX-License-Identifier: BSD-3-Clause
// The tables of docs/results/announced_plans.md, from what lab/studies/plans/run has flown.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iterator>
#include <sstream>
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

/// φ² under the law and under plans, over the seeds that both flew.
struct Pairs {
  Pairs(const fs::path& folder, const std::string& setting, const std::string& row) {
    const Flights of_law = flights_of(folder / ("law-" + row + ".csv"));
    const Flights of_plans = flights_of(folder / (setting + "-" + row + ".csv"));
    const auto runs =
        static_cast<std::ptrdiff_t>(std::min(of_law.seeds.size(), of_plans.seeds.size()));
    if (!std::equal(of_law.seeds.begin(), of_law.seeds.begin() + runs, of_plans.seeds.begin())) {
      throw std::runtime_error("other seeds of " + row + " under " + setting);
    }
    law.assign(of_law.metrics.begin(), of_law.metrics.begin() + runs);
    plans.assign(of_plans.metrics.begin(), of_plans.metrics.begin() + runs);
  }

  /// "runs: ratio of the means (interval) · ratio of the worst".
  std::string against() const {
    const Estimate ratio = ratio_of(plans, law);
    const double worst =
        *std::max_element(plans.begin(), plans.end()) / *std::max_element(law.begin(), law.end());
    char text[96];
    std::snprintf(text, sizeof text, "%zu: %.3g (%.3g to %.3g) · %.2g", law.size(), ratio.value,
                  ratio.low, ratio.high, worst);
    return text;
  }

  std::vector<double> law, plans;
};

/// The first setting also with its φ²; others that have not flown the row get a dash.
void print_row(const fs::path& folder, const std::vector<std::string>& settings,
               const std::string& row) {
  const Pairs first(folder, settings.front(), row);
  std::string name = row;
  std::replace(name.begin(), name.end(), '_', ' ');
  std::printf("| %s | %s | %s |", name.c_str(), spread(first.law).c_str(),
              spread(first.plans).c_str());
  for (const std::string& setting : settings) {
    const bool flown = fs::exists(folder / (setting + "-" + row + ".csv"));
    std::printf(" %s |", flown ? Pairs(folder, setting, row).against().c_str() : "–");
  }
  std::printf("\n");
}

void print_table(const fs::path& folder, const std::string& names, int rows, char** row) {
  std::istringstream words(names);
  const std::vector<std::string> settings{std::istream_iterator<std::string>(words), {}};
  if (settings.empty()) throw std::runtime_error("no setting");
  std::string head = "| | the law | " + settings.front() + " |", rule = "|---|---|---|";
  for (const std::string& setting : settings) {
    head += " " + setting + " against the law |";
    rule += "---|";
  }
  std::printf("%s\n%s\n", head.c_str(), rule.c_str());
  for (int i = 0; i < rows; ++i) print_row(folder, settings, row[i]);
  std::printf("\n");
}

}  // namespace
}  // namespace ergocast::studies

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: studies-plans FOLDER 'SETTING...' ROW...\n");
    return 2;
  }
  try {
    ergocast::studies::print_table(argv[1], argv[2], argc - 3, argv + 3);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "studies-plans: %s\n", error.what());
    return 2;
  }
}
