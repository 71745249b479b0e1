// SPDX-License-Identifier: BSD-3-Clause
// A file of the registry of live runs: refused with a reason, or a run that is written as it was
// read.
#include "cli/watch/run_registry.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(run_entry) {
  const auto read = cli::live_run_from(text_of(input));
  if (const auto* problem = std::get_if<std::string>(&read)) {
    ERGOCAST_REQUIRE(!problem->empty());
    return;
  }
  const std::string text = cli::to_json_text(std::get<cli::LiveRun>(read));
  const auto again = cli::live_run_from(text);
  ERGOCAST_REQUIRE(std::holds_alternative<cli::LiveRun>(again));
  ERGOCAST_REQUIRE(cli::to_json_text(std::get<cli::LiveRun>(again)) == text);
}

}  // namespace ergocast::fuzz
