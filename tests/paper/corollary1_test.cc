// SPDX-License-Identifier: BSD-3-Clause
// Corollary 1: without noise, ‖x(t) − c‖ is bounded by a contraction towards a ball.
//
// Euler steps break the continuous inequality by O(k·dt); what holds at every step is its discrete
// form  ‖x_n − c‖ ≤ qⁿ ‖x_0 − c‖ + (u_max/k)(1 − qⁿ),  q = 1 − k·dt.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "studies/theorems/bounds.h"

namespace ergocast::test {
namespace {

using lab::Edges;
using studies::Contraction;
using studies::contraction_of;

TEST(Corollary1, DiscreteBoundHoldsAtEveryStepOfEveryRandomMission) {
  for (const Edges edges : {Edges::kReflect, Edges::kNone}) {
    double largest_allowance_m = 0;
    for (std::uint64_t seed = 1; seed <= 500; ++seed) {
      const Contraction found = contraction_of(studies::random_mission(seed), edges);
      EXPECT_EQ(found.violations, 0) << "seed " << seed;
      largest_allowance_m = std::max(largest_allowance_m, found.allowance_m);
    }
    EXPECT_LT(largest_allowance_m, 1e-7) << "rounding cannot be that large";
  }
}

class DrivenOutward : public ::testing::TestWithParam<double> {
 protected:
  double k_dt() const { return GetParam(); }
  Contraction found() const {
    ControlLaw law;
    law.u_max_mps = 10;
    law.contraction_gain_per_s = k_dt() / 0.1;
    return contraction_of(studies::driven_outward(law, 0.1, 100), Edges::kNone);
  }
};

TEST_P(DrivenOutward, MeetsTheDiscreteBoundAndDoesNotExceedIt) {
  EXPECT_EQ(found().violations, 0);
  EXPECT_NEAR(found().largest_share, 1, 1e-12);
}

// In the first step it goes u_max dt, and the continuous statement allows (u_max/k)(1 − e^(−k·dt)):
// a share of k·dt/(1 − e^(−k·dt)) = 1 + k·dt/2 + …
TEST_P(DrivenOutward, BreaksTheContinuousBoundByHalfOfGainTimesStep) {
  EXPECT_NEAR(found().largest_continuous_share, k_dt() / -std::expm1(-k_dt()), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Corollary1, DrivenOutward, ::testing::Values(1e-3, 1e-2, 0.1, 0.5, 1.0));

}  // namespace
}  // namespace ergocast::test
