// SPDX-License-Identifier: BSD-3-Clause
// A compiled plan as it comes from the network: refused in a sentence, or a mission that can be
// flown.
#include <cmath>

#include "scenario/scenario.h"
#include "tests/fuzz/target.h"

namespace ergocast::fuzz {

FUZZ_TARGET(plan) {
  const auto read = Scenario::from_plan(bytes_of(input));
  if (const auto* problem = std::get_if<std::string>(&read)) {
    ERGOCAST_REQUIRE(!problem->empty());
    for (const char c : *problem) ERGOCAST_REQUIRE(c >= ' ' && c <= '~');
    return;
  }
  const Scenario& scenario = std::get<Scenario>(read);
  const auto bytes = bytes_of(input);
  ERGOCAST_REQUIRE(
      std::equal(bytes.begin(), bytes.end(), scenario.plan().begin(), scenario.plan().end()));
  const Mission& mission = scenario.mission();
  ERGOCAST_REQUIRE(!mission.starts_m.empty() && mission.starts_m.size() <= kMaxAgents);
  for (const Eigen::Vector2d& start : mission.starts_m)
    ERGOCAST_REQUIRE(mission.domain.contains(start));
  ERGOCAST_REQUIRE(mission.timing.tick_count >= 1 && mission.timing.dt_s > 0);
  for (const double mu : mission.target_coefficients.reshaped())
    ERGOCAST_REQUIRE(std::abs(mu) <= 1 + 1e-6);
}

}  // namespace ergocast::fuzz
