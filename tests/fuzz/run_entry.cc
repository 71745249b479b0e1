// SPDX-License-Identifier: BSD-3-Clause
// A file of the registry of live runs: refused with a reason, or a run that is written as it was
// read.
#include "cli/watch/run_registry.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(run_entry) {
  const auto read = cli::live_run_from(text_of(input));
  if (!read) {
    ERGOCAST_REQUIRE(!read.error().empty());
    return;
  }
  const std::string text = cli::to_json_text(*read);
  const auto again = cli::live_run_from(text);
  ERGOCAST_REQUIRE(again.has_value());
  ERGOCAST_REQUIRE(cli::to_json_text(*again) == text);
}

}  // namespace ergocast::fuzz
