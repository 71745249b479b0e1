// SPDX-License-Identifier: BSD-3-Clause
// The page and the terminal show the same summaries.
#include "cli/study/study_results.h"

#include <algorithm>
#include <cstdio>

#include "logger/run_record.h"
#include "runtime/process/program_options.h"
#include "studies/study_page.h"
#include "text/printable.h"
#include "text/shell_word.h"

namespace ergocast::cli {

std::optional<std::string> conclude(StudyDirectory& directory, const StudyResults& results) {
  if (auto problem = directory.sort()) return problem;
  const auto summaries = studies::summarize(results.study, directory.rows());
  std::printf("%s", studies::study_text(results.study, summaries).c_str());
  for (const studies::Quantity& quantity : studies::quantities()) {
    if (std::ranges::find(results.measures, quantity.column) == results.measures.end()) continue;
    const auto measured = studies::summarize(results.study, directory.rows(), quantity);
    std::printf("\n%s", quantity_text(results.study, quantity.column, measured).c_str());
  }
  std::printf("\none mission of each row, here with the first seed:\n");
  std::vector<std::string> missions = results.missions;
  for (std::string& mission : missions) {
    mission += " --seed " + std::to_string(results.first_seed);
    std::printf("  %s\n", printable(mission).c_str());
  }
  const std::string command = results.command + " --out " + shell_word(results.out.string());
  return write_file(results.out / "report.html",
                    studies::study_page({results.study, version(), command, missions}, summaries));
}

}  // namespace ergocast::cli
