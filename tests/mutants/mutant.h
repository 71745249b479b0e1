// SPDX-License-Identifier: BSD-3-Clause
// Selects the mutant of a process: tests/mutants/run builds a copy of the tree with all mutants.
#pragma once

#include <cstdlib>

namespace ergocast {

/// The number in the environment variable MUT; 0: none.
inline const int kSelectedMutant = [] {
  const char* const number = std::getenv("MUT");
  return number == nullptr ? 0 : std::atoi(number);
}();

/// Whether this process is mutant `number`.
inline bool is_mutant(int number) { return kSelectedMutant == number; }

}  // namespace ergocast
