// SPDX-License-Identifier: BSD-3-Clause
// `ergocast amend --zone`: real processes leave a part of the domain, and keep out of it.
#include <algorithm>
#include <map>

#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

class ZoneCommand : public RunningMission {
 protected:
  /// A square round all peaks of the target, so that agents are inside.
  std::filesystem::path square() const {
    std::ofstream file(folder_ / "square.textproto");
    for (const auto& [x_m, y_m] : {std::pair{200, 200}, {1800, 200}, {1800, 1800}, {200, 1800}})
      file << "vertices { x_m: " << x_m << " y_m: " << y_m << " }\n";
    return folder_ / "square.textproto";
  }
  /// How many agents are in the square at each recorded tick.
  std::map<Tick, int> counts_inside() const {
    std::map<Tick, int> counts;
    for (const auto& [tick, row] : recorded_rows(out()))
      counts[tick] = static_cast<int>(std::ranges::count_if(row, [](const auto& one) {
        const auto& [x_m, y_m] = std::pair(one.second.x_m, one.second.y_m);
        return x_m > 200 && x_m < 1800 && y_m > 200 && y_m < 1800;
      }));
    return counts;
  }
};
class ZoneInEitherPace : public ZoneCommand, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Paces, ZoneInEitherPace, ::testing::Values("--lockstep", "--realtime=10"),
                         name_of_pace);

TEST_P(ZoneInEitherPace, SendsTheTeamOutAndKeepsItOut) {
  Child mission = launch_endless(scenario(), {GetParam(), "--lcm-url", kUrl});
  ASSERT_TRUE(moves_on(400000)) << printed();  // all are inside
  const std::vector<std::string> order = {"--zone", square(), "--for", "1000000s"};
  std::vector<std::string> tried = order;
  tried.emplace_back("--dry-run");
  ASSERT_EQ(amend(tried), 0) << output();
  EXPECT_TRUE(answered("nothing was sent")) << output();
  const int code = amend(order);
  EXPECT_TRUE(answered(code == 0 ? "nobody is in it" : " in it")) << output();
  const Tick from = since_tick();
  ASSERT_TRUE(moves_on(200000)) << printed();
  ASSERT_EQ(amend({"--list"}), 0) << output();
  EXPECT_TRUE(answered("amendment 0, zone ")) << output();
  EXPECT_TRUE(logs("coordinator", "vehicles leave zone ")) << log_of("coordinator");
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
  const std::map<Tick, int> inside = counts_inside();
  const auto is_inside = [](const auto& count) { return count.second > 0; };
  const auto at = inside.lower_bound(from);
  EXPECT_TRUE(std::any_of(inside.begin(), at, is_inside)) << "the target draws them there";
  // An agent whose commands came too late may leave later, but nobody comes back.
  const auto left = std::find_if_not(at, inside.end(), is_inside);
  EXPECT_NE(left, inside.end());
  EXPECT_TRUE(std::none_of(left, inside.end(), is_inside));
  if (all_on_time()) {
    EXPECT_EQ(code, 0);
    EXPECT_EQ(left, at);
  }
  if (GetParam() != std::string("--lockstep")) return;
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_TRUE(answered("identical to its simulation")) << output();
}

TEST_P(ZoneInEitherPace, IsCancelled) {
  Child mission = launch_endless(scenario(), {GetParam(), "--lcm-url", kUrl});
  ASSERT_TRUE(moves_on(200000)) << printed();
  // On a slow machine agents leave later.
  if (const int code = amend({"--zone", square(), "--for", "1000000s"}); code != 0) {
    ASSERT_EQ(code, 4) << output();
    ASSERT_TRUE(answered(" in it")) << output();
  }
  ASSERT_EQ(amend({"--list"}), 0) << output();
  EXPECT_TRUE(answered("(--cancel undoes it)")) << output();
  ASSERT_EQ(amend({"--cancel", "0"}), 0) << output();
  EXPECT_TRUE(answered("amendment 1, the end of the zone of amendment 0, ")) << output();
  const Tick from = since_tick();
  EXPECT_EQ(amend({"--cancel", "0"}), 4) << output();
  EXPECT_TRUE(answered("is a zone that has ended")) << output();
  ASSERT_EQ(amend({"--list"}), 0) << output();
  EXPECT_TRUE(answered(": amendment 1 cancelled it")) << output();
  ASSERT_EQ(ergocast({"status", "--json", "--lcm-url", kUrl}), 0) << output();
  EXPECT_TRUE(answered("\"zones\":[]")) << output();
  ASSERT_TRUE(moves_on(400000)) << printed();
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
  const std::map<Tick, int> inside = counts_inside();
  EXPECT_TRUE(std::any_of(inside.lower_bound(from), inside.end(), [](const auto& count) {
    return count.second > 0;
  })) << "the target draws them there again";
  EXPECT_NE(printed().find(", when amendment 1 cancelled it; at t = "), std::string::npos)
      << printed();
  if (GetParam() != std::string("--lockstep")) return;
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_TRUE(answered("identical to its simulation")) << output();
}

TEST_F(ZoneCommand, ADryRunNamesThatThereIsNoPlaceForANinthZone) {
  Child mission = launch_endless(scenario(), {"--lcm-url", kUrl});
  const std::vector<std::string> order = {"--zone", square(), "--for", "1000000s"};
  for (int i = 0; i < 8; ++i) ASSERT_EQ(amend(order), 0) << output();
  std::vector<std::string> tried = order;
  tried.emplace_back("--dry-run");
  EXPECT_EQ(amend(tried), 4) << output();
  EXPECT_TRUE(answered("8 zones are in force")) << output();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(ZoneCommand, IsRehearsedInASimulationThatNamesItInItsLastLines) {
  EXPECT_EQ(ergocast({"simulate", scenario(), "--duration", "200", "--out", out(), "--amend",
                      "150+20:" + square().string()}),
            0)
      << output();
  EXPECT_TRUE(answered("\n  zone      amendment 0 closed from t = ")) << output();
  EXPECT_TRUE(answered(" until t = 170.0 s; at t = 150.0 s nobody was inside\n")) << output();
}

}  // namespace
}  // namespace ergocast::test
