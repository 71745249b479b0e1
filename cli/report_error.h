// SPDX-License-Identifier: BSD-3-Clause
// How a command reports an error and ends.
#pragma once

#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/process/program_options.h"
#include "scenario/scenario.h"
#include "text/printable.h"

namespace ergocast::cli {

/// Longer lists and lines are cut.
inline constexpr std::size_t kMostLines = 50, kMostBytes = 2000;

/// Writes one line for people. All errors of the command pass through here. The text may contain
/// bytes of a file or another host; printable() escapes those that would control the terminal.
inline void print_message(const std::string& text) {
  const std::string shown = printable(std::string_view(text).substr(0, kMostBytes));
  std::fprintf(stderr, "%s%s\n", shown.c_str(), text.size() > kMostBytes ? "…" : "");
}

/// Writes one line on standard error; returns the exit code.
inline int report_error(ExitCode code, const std::string& problem) {
  print_message(problem);
  return code;
}

/// Writes one line for each problem.
inline int report_error(ExitCode code, const std::vector<std::string>& problems) {
  for (std::size_t i = 0; i < std::min(problems.size(), kMostLines); ++i)
    print_message(problems[i]);
  if (problems.size() > kMostLines)
    print_message("and " + std::to_string(problems.size() - kMostLines) + " more");
  return code;
}
inline int report_error(ExitCode code, const std::vector<Problem>& problems) {
  std::vector<std::string> lines;
  for (const Problem& problem : problems) lines.push_back(to_string(problem));
  return report_error(code, lines);
}

}  // namespace ergocast::cli
