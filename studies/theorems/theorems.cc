// SPDX-License-Identifier: BSD-3-Clause
// The program of studies/theorems/run: lists the parts, simulates one, reports on all.
#include "studies/theorems/theorems.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string_view>

#include "core/base/require.h"
#include "scenario/scenario.h"

namespace ergocast::studies {

namespace fs = std::filesystem;

namespace {

std::vector<Part> all_parts(int seeds) {
  std::vector<Part> all;
  for (const auto& parts :
       {theorem1_parts, fig2a_parts, theorem2_parts, corollary1_parts, proposition1_parts}) {
    for (Part& part : parts(seeds)) all.push_back(std::move(part));
  }
  return all;
}

/// Skips a part whose file exists. An interrupted part has no file of that name.
void simulate(const std::string& name, const fs::path& folder, int seeds) {
  const fs::path file = folder / (name + ".csv"), unfinished = folder / (name + ".part");
  if (fs::exists(file)) return;
  for (const Part& part : all_parts(seeds)) {
    if (part.name != name) continue;
    std::ofstream out(unfinished);
    out.precision(10);
    part.write(out);
    out.close();
    if (!out) throw std::runtime_error(unfinished.string() + ": cannot be written");
    fs::rename(unfinished, file);
    return;
  }
  throw std::runtime_error("there is no part '" + name + "'");
}

void report(const fs::path& folder, const fs::path& curves) {
  report_theorem1(folder, curves);
  report_fig2a(folder);
  report_theorem2(folder, curves);
  report_corollary1(folder);
  report_proposition1(folder, curves);
}

int run(int argc, char** argv) {
  const std::string_view what = argc > 1 ? argv[1] : "";
  if (what == "list" && argc == 2) {
    for (const Part& part : all_parts(1)) std::cout << part.name << '\n';
  } else if (what == "simulate" && argc == 5) {
    simulate(argv[2], argv[3], std::stoi(argv[4]));
  } else if (what == "report" && argc == 4) {
    report(argv[2], argv[3]);
  } else {
    std::fprintf(
        stderr,
        "usage: studies-theorems list | simulate PART FOLDER SEEDS | report FOLDER CURVES\n");
    return 2;
  }
  return 0;
}

}  // namespace

Mission paper_mission() {
  const auto loaded = Scenario::load(fs::path(ERGOCAST_SCENARIO_DIR) / "paper_fig2a.textproto");
  ERGOCAST_REQUIRE(loaded);
  return loaded->mission();
}

}  // namespace ergocast::studies

int main(int argc, char** argv) {
  try {
    return ergocast::studies::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "studies-theorems: %s\n", error.what());
    return 2;
  }
}
