// Corollary 1: without noise, ‖x(t) − c‖ is bounded by a contraction towards a ball.
//
// Euler steps break the continuous inequality by O(k·dt); what holds at every step is its discrete
// form  ‖x_n − c‖ ≤ qⁿ ‖x_0 − c‖ + (u_max/k)(1 − qⁿ),  q = 1 − k·dt.
#include <gtest/gtest.h>

#include <cmath>

#include "core/noise.h"
#include "tests/support/paper_team.h"

namespace ergocast::test {
namespace {

/// A mission without noise, its numbers drawn from `seed`.
Mission drawn(std::uint64_t seed) {
  const auto uniform = [seed](std::uint64_t n) {
    return uniform_pair(seed, Purpose::kStart, 7, n);
  };
  Mission mission = shipped_mission("paper_fig2a");
  mission.law.noise_intensity = 0;
  mission.law.epsilon = std::pow(10, -6 + 6 * uniform(0).x());
  mission.law.u_max_mps = 1 + 40 * uniform(0).y();
  mission.law.contraction_gain_per_s = std::pow(10, -4 + 4 * uniform(1).x());
  mission.law.contraction_center_m = 2000 * uniform(2);
  mission.starts_m = {2000 * uniform(3), 2000 * uniform(4)};
  return mission;
}

TEST(Corollary1, DiscreteBoundHoldsAtEveryStep) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    PaperTeam team(drawn(seed));
    const ControlLaw& law = team.mission().law;
    const Eigen::Vector2d center_m = law.contraction_center_m;
    const double q = 1 - law.contraction_gain_per_s * team.mission().timing.dt_s;
    double q_n = 1;
    team.run_until(100, [&] {
      q_n *= q;
      for (std::size_t i = 0; i < team.size(); ++i) {
        const double start_m = (team.mission().starts_m[i] - center_m).norm();
        const double bound_m =
            q_n * start_m + law.u_max_mps / law.contraction_gain_per_s * (1 - q_n);
        ASSERT_LE((team.x_m(i) - center_m).norm(), bound_m * (1 + 1e-9) + 1e-9)
            << "seed " << seed << ", agent " << i << ", t = " << team.t_s() << " s";
      }
    });
  }
}

}  // namespace
}  // namespace ergocast::test
