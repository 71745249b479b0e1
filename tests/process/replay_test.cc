// SPDX-License-Identifier: BSD-3-Clause
// A recorded mission is replayed on one URL, as LCM's player does: `ergocast status` shows all of
// it.
#include "tests/process/mission.h"

namespace ergocast::test {
namespace {

using Replay = ByHand;

TEST_F(Replay, ShowsTheWholeTeamAndItsEnd) {
  // By the clock, so that the log lasts as long on any machine.
  ASSERT_EQ(ergocast({"run", scenario_file("quadrimodal_corners"), "--realtime", "--duration", "8",
                      "--out", out()}),
            0)
      << output();
  Program& watch = hand("ergocast", {"status", "--watch"});
  ASSERT_TRUE(watch.says("nobody is heard on ")) << watch.said();
  Child player =
      std::get<Child>(Child::start({{"/usr/bin/lcm-logplayer", std::string("--lcm-url=") + kUrl,
                                     (out() / "events-000.lcm").string()},
                                    folder_ / "player",
                                    SIGKILL}));
  EXPECT_EQ(wait_for(watch.child), 0) << watch.said();
  const std::string said = watch.said();
  for (const char* process : {"coordinator  alive", "world        alive", "logger       alive"}) {
    EXPECT_NE(said.find(process), std::string::npos) << said;
  }
  // An ended mission is not alive, although its messages are recent.
  const std::string end = said.substr(said.rfind("quadrimodal_corners, run "));
  EXPECT_NE(end.find("the mission has ended"), std::string::npos) << end;
  EXPECT_EQ(end.find("alive"), std::string::npos) << end;
  EXPECT_NE(end.find("world        ended"), std::string::npos) << end;
  wait_for(player);
}

}  // namespace
}  // namespace ergocast::test
