// SPDX-License-Identifier: BSD-3-Clause
// A compiled plan from the network: refused with one sentence, or a mission that a scenario can
// describe.
#include "plan/plan.h"

#include <algorithm>
#include <cmath>

#include "logger/mission_text.h"
#include "scenario/scenario.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(plan) {
  const auto read = decode_plan(bytes_of(input));
  if (!read) {
    ERGOCAST_REQUIRE(!read.error().empty());
    for (const char c : read.error()) ERGOCAST_REQUIRE(c >= ' ' && c <= '~');
    return;
  }
  const Mission& mission = *read;
  ERGOCAST_REQUIRE(std::ranges::equal(encode_plan(mission), bytes_of(input)));
  for (const double mu : mission.target_coefficients.reshaped())
    ERGOCAST_REQUIRE(std::abs(mu) <= 1 + 1e-6);
  const auto parsed =
      Scenario::parse(mission_text(mission) + "target { uniform_weight: 1 }", "plan");
  ERGOCAST_REQUIRE(parsed.has_value());
  ERGOCAST_REQUIRE(parsed->mission().timing.tick_count == mission.timing.tick_count);
}

}  // namespace ergocast::fuzz
