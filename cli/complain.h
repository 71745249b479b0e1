// How a command that cannot go on says why.
#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "runtime/node.h"
#include "scenario/scenario.h"

namespace ergocast::cli {

/// One line on standard error; returns the exit code.
inline int complain(ExitCode code, const std::string& problem) {
  std::fprintf(stderr, "%s\n", problem.c_str());
  return code;
}

/// A line for each of several.
inline int complain(ExitCode code, const std::vector<std::string>& problems) {
  for (const std::string& problem : problems) complain(code, problem);
  return code;
}
inline int complain(ExitCode code, const std::vector<Problem>& problems) {
  for (const Problem& problem : problems) complain(code, to_string(problem));
  return code;
}

}  // namespace ergocast::cli
