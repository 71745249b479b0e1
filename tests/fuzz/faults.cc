// SPDX-License-Identifier: BSD-3-Clause
// A file of faults for the laboratory.
#include "cli/study/fault_file.h"
#include "tests/fuzz/files.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(faults) {
  const auto read = cli::read_faults(memory_file(input));
  if (!read) {
    ERGOCAST_REQUIRE(!read.error().empty());
    return;
  }
  const auto& faults = *read;
  for (const lab::FaultField& field : lab::fault_fields()) {
    ERGOCAST_REQUIRE(faults.*field.value >= 0 && faults.*field.value <= field.most);
  }
}

}  // namespace ergocast::fuzz
