// SPDX-License-Identifier: BSD-3-Clause
// A problem of a scenario, as people read it.
#pragma once

#include <string>

namespace ergocast {

/// One problem of a scenario.
struct Problem {
  std::string where;   ///< "file:line:column" or "file: field.path"
  std::string what;    ///< the error, with the limit it breaks
  std::string remedy;  ///< what to write instead
};
/// "where: what (remedy)", one line.
std::string to_string(const Problem& problem);

}  // namespace ergocast
