// SPDX-License-Identifier: BSD-3-Clause
// Targets that change while a team covers them: the figures of docs/law.md.
#include "studies/changing/changing.h"

#include <cstdio>
#include <exception>
#include <stdexcept>
#include <string>

namespace ergocast::studies {
namespace {

void study(const std::string& part, int seeds, const std::string& file) {
  Results results;
  if (part == "jumps") {
    study_jumps(seeds, results);
  } else if (part == "drifts") {
    study_drifts(seeds, results);
  } else if (part == "messages") {
    study_messages(seeds, results);
  } else {
    throw std::runtime_error("unknown part " + part);
  }
  results.write(file);
}

}  // namespace
}  // namespace ergocast::studies

int main(int argc, char** argv) try {
  if (argc != 4) throw std::runtime_error("usage: studies-changing PART SEEDS FILE.csv");
  ergocast::studies::study(argv[1], std::stoi(argv[2]), argv[3]);
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
