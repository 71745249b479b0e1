// SPDX-License-Identifier: BSD-3-Clause
// The overrides of `--set`: one "path=value" in each line.
#include "scenario/scenario.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {
namespace {

constexpr std::string_view kScenario =
    "domain { size_x_m: 2000 size_y_m: 1000 } target { uniform_weight: 1 } "
    "basis { modes_x: 3 modes_y: 3 } law { u_max_mps: 10 } time { duration_s: 10 } "
    "agents { starts { x_m: 1 y_m: 2 } random_count: 1 }";

}  // namespace

FUZZ_TARGET(scenario_overrides) {
  Overrides overrides;
  std::string_view rest = text_of(input);
  while (!rest.empty() && overrides.fields.size() < 8) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    const std::size_t equals = line.find('=');
    if (equals == std::string_view::npos) continue;
    overrides.fields.push_back(
        {std::string(line.substr(0, equals)), std::string(line.substr(equals + 1)), "--set"});
  }
  const auto parsed = Scenario::parse(kScenario, "base", overrides);
  if (!parsed) {
    ERGOCAST_REQUIRE(!parsed.error().empty());
  }
}

}  // namespace ergocast::fuzz
