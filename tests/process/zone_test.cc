// SPDX-License-Identifier: BSD-3-Clause
// `ergocast amend --zone`: real processes leave a part of the domain, and keep out of it.
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
  /// The rows in the square, of the ticks from one on, and of those before.
  std::pair<int, int> rows_inside(Tick from) const {
    std::pair<int, int> count;
    for (const auto& [tick, row] : recorded_rows(out()))
      for (const auto& [id, one] : row)
        if (one.x_m > 200 && one.x_m < 1800 && one.y_m > 200 && one.y_m < 1800)
          ++(tick >= from ? count.first : count.second);
    return count;
  }
};
class ZoneInEitherPace : public ZoneCommand, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Paces, ZoneInEitherPace, ::testing::Values("--lockstep", "--realtime=10"),
                         [](const auto& pace) {
                           return pace.index == 0 ? "Lockstep" : "Realtime";
                         });

TEST_P(ZoneInEitherPace, SendsTheTeamOutAndKeepsItOut) {
  Child mission = launch_endless(scenario(), {GetParam(), "--lcm-url", kUrl});
  ASSERT_TRUE(moves_on(400000)) << printed();  // all are inside
  const std::vector<std::string> order = {"--zone", square(), "--for", "1000000s"};
  std::vector<std::string> tried = order;
  tried.emplace_back("--dry-run");
  ASSERT_EQ(amend(tried), 0) << output();
  EXPECT_TRUE(answered("nothing was sent")) << output();
  ASSERT_EQ(amend(order), 0) << output();
  EXPECT_TRUE(answered("nobody is in it")) << output();
  const std::string printed_text = output(), since = "holds since tick ";
  ASSERT_NE(printed_text.find(since), std::string::npos) << printed_text;
  const Tick from = std::stoll(printed_text.substr(printed_text.find(since) + since.size()));
  ASSERT_TRUE(moves_on(200000)) << printed();
  ASSERT_EQ(amend({"--list"}), 0) << output();
  EXPECT_TRUE(answered("amendment 0, zone ")) << output();
  EXPECT_TRUE(logs("coordinator", " is closed from tick ")) << log_of("coordinator");
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
  const auto [after, before] = rows_inside(from);
  EXPECT_EQ(after, 0);
  EXPECT_GT(before, 0) << "the target draws them there";
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
