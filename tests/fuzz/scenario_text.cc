// SPDX-License-Identifier: BSD-3-Clause
// A scenario's text and its rules, without the integrals over its target, which take too long for
// millions of texts. A negative weight in each keeps the loader from them.
#include "scenario/scenario.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(scenario_text) {
  Overrides overrides;
  overrides.fields.push_back({"target.uniform_weight", "-1", "--set"});
  const auto parsed = Scenario::parse(text_of(input), "/fuzzed/mission.textproto", overrides);
  ERGOCAST_REQUIRE(!parsed && !parsed.error().empty());
  for (const Problem& problem : parsed.error()) {
    ERGOCAST_REQUIRE(!problem.where.empty() && !problem.what.empty() && !problem.remedy.empty());
  }
}

}  // namespace ergocast::fuzz
