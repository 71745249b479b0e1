// SPDX-License-Identifier: BSD-3-Clause
// `ergocast amend --law`: real agents cover at another speed, from the tick on that all know.
#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

constexpr double kSlow_mps = 2;

class LawCommand : public RunningMission, public ::testing::WithParamInterface<const char*> {
 protected:
  /// The mean speed of all agents in the rows of the ticks from one up to another.
  double mean_mps(Tick from, Tick until = std::numeric_limits<Tick>::max()) const {
    double sum_mps = 0;
    int count = 0;
    for (const auto& [tick, row] : recorded_rows(out())) {
      if (tick < from || tick >= until) continue;
      for (const auto& [id, one] : row) sum_mps += std::hypot(one.vx_mps, one.vy_mps);
      count += static_cast<int>(row.size());
    }
    return sum_mps / std::max(1, count);
  }
};
INSTANTIATE_TEST_SUITE_P(Paces, LawCommand, ::testing::Values("--lockstep", "--realtime=10"),
                         name_of_pace);

TEST_P(LawCommand, SlowsTheTeamDownAndIsCancelled) {
  Child mission = launch_endless(scenario(), {GetParam(), "--lcm-url", kUrl});
  EXPECT_EQ(amend({"--law", "u_max_mps=21"}), 2) << output();
  EXPECT_TRUE(answered("at most that of the plan, 20 m/s")) << output();
  EXPECT_EQ(amend({"--law", "speed=1"}), 2) << output();
  ASSERT_EQ(amend({"--law", "u_max_mps=2", "--dry-run"}), 0) << output();
  EXPECT_TRUE(answered("u_max_mps 2")) << output();
  EXPECT_TRUE(answered("nothing was sent")) << output();
  // Less noise, too, which is as fast as that.
  ASSERT_EQ(amend({"--law", "u_max_mps=2", "--law", "noise_intensity=0.1"}), 0) << output();
  EXPECT_TRUE(answered("amendment 0, law ")) << output();
  EXPECT_TRUE(answered(", by ")) << output();
  const Tick slow = since_tick();
  ASSERT_TRUE(moves_on(100000)) << printed();
  ASSERT_EQ(ergocast({"status", "--json", "--lcm-url", kUrl}), 0) << output();
  const auto status = nlohmann::json::parse(output());
  EXPECT_EQ(status["law"]["amendment"], 0);
  EXPECT_EQ(status["law"]["kinds"][0]["u_max_mps"], kSlow_mps);
  ASSERT_EQ(amend({"--list"}), 0) << output();
  EXPECT_TRUE(answered(" (--cancel undoes it)")) << output();
  ASSERT_EQ(amend({"--cancel", "0"}), 0) << output();
  EXPECT_TRUE(answered("(as planned)")) << output();
  const Tick fast = since_tick();
  ASSERT_TRUE(moves_on(100000)) << printed();
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
  const bool exact = GetParam() == std::string("--lockstep");
  EXPECT_GT(mean_mps(0, slow), 3 * kSlow_mps);
  // A row may have the velocity of the step that led there; in real time commands may be late.
  EXPECT_LT(mean_mps(slow + 10, fast), 2 * kSlow_mps);
  EXPECT_GT(mean_mps(fast + 10), 3 * kSlow_mps);
  const auto recorded = nlohmann::json::parse(text_of(out() / "amendments.json"));
  EXPECT_EQ(recorded["amendments"][0]["law"][0]["u_max_mps"], kSlow_mps);
  EXPECT_FALSE(recorded["amendments"][0]["by"].get<std::string>().empty());
  if (!exact) return;
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_TRUE(answered("identical to its simulation")) << output();
  EXPECT_EQ(ergocast({"report", out()}), 0) << output();
}

}  // namespace
}  // namespace ergocast::test
