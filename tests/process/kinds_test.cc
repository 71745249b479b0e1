// SPDX-License-Identifier: BSD-3-Clause
// Real processes of several kinds: their record, what is said of them, and a kind that nobody
// knows.
#include "tests/process/mission.h"

namespace ergocast::test {
namespace {

class MixedRun : public OwnHost {};

TEST_F(MixedRun, InLockstepIsItsSimulationAndTheRecordNamesTheKinds) {
  ASSERT_EQ(ergocast({"run", scenario_file("mixed_team"), "--lockstep", "--duration", "10", "--out",
                      out()}),
            0)
      << output();
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  const auto agents = summary()["agents"];
  ASSERT_EQ(agents.size(), 4u);
  EXPECT_EQ(agents[0]["kind"], "scout");
  EXPECT_EQ(agents[3]["kind"], "inspector");
  const std::string page = text_of(out() / "report.html");
  EXPECT_NE(page.find("inspector: 2 agents, u_max = 6 m/s, sees a Gaussian of 2 m"), page.npos);
}

class KindByHand : public ByHand {};

TEST_F(KindByHand, ThatTheMissionDoesNotHaveEndsTheAgentWithASentence) {
  Program& coordinator = hand("ergocast-coordinator", {scenario_file("mixed_team")});
  Program& stranger = hand("ergocast-agent", {"--id", "0", "--kind", "diver"});
  EXPECT_EQ(wait_for(stranger.child), 4) << stranger.said();
  EXPECT_TRUE(stranger.says("the mission has no kind \"diver\": its kinds are scout, inspector"))
      << stranger.said() << coordinator.said();
}

}  // namespace
}  // namespace ergocast::test
