// How a command that cannot go on says why.
#pragma once

#include <cstdio>
#include <string>

#include "runtime/node.h"

namespace ergocast::cli {

/// One line on standard error; returns the exit code.
inline int complain(ExitCode code, const std::string& problem) {
  std::fprintf(stderr, "%s\n", problem.c_str());
  return code;
}

}  // namespace ergocast::cli
