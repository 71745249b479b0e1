// SPDX-License-Identifier: BSD-3-Clause
// `ergocast recall`: real processes go home and rest there, or leave, while the others go on. A
// recall outlasts the coordinator that obeyed it, and the process that it was for.
#include <cmath>

#include "tests/process/support/bus_observer.h"
#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

class RecallCommand : public RunningMission {
 protected:
  int recall(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "recall");
    arguments.insert(arguments.end(), {"--lcm-url", kUrl});
    return ergocast(arguments);
  }
  /// Whether `ergocast status` shows that word.
  bool shown(const std::string& word) {
    ergocast({"status", "--lcm-url", kUrl});
    return answered(word);
  }
  nlohmann::json process(const std::string& name) const {
    const nlohmann::json all = summary();
    for (const auto& one : all["processes"]) {
      if (one["name"] == name) return one;
    }
    return {};
  }
};

TEST_F(RecallCommand, SendsAgentsHomeAndOutOfAMissionThatIsDone) {
  Child mission = launch_held(scenario(), {"--lcm-url", kUrl});
  BusObserver observer(kUrl);
  Child home = start("ergocast", {"recall", "1", "--lcm-url", kUrl});
  Child out_of_it = start("ergocast", {"recall", "2", "--leave", "--lcm-url", kUrl});
  ASSERT_TRUE(observer.observes([&] {
    const RosterEntry *one = observer.entry(observer.member(1)),
                      *two = observer.entry(observer.member(2));
    return one != nullptr && one->recalled() && two != nullptr && two->leaves;
  })) << printed();
  release();
  EXPECT_EQ(wait_for(home), 0);
  EXPECT_EQ(wait_for(out_of_it), 0);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["result"], "done") << summary();
  EXPECT_TRUE(printed("agent-2 was sent out of the mission")) << printed();
  EXPECT_NE(log_of("agent-2").find("sent out of the mission by the operator"), std::string::npos);
  EXPECT_EQ(process("agent-2")["restarts"], 0) << process("agent-2");
  EXPECT_NE(process("agent-2").dump().find("code 0"), std::string::npos) << process("agent-2");

  const auto recalls = summary()["recalls"];
  ASSERT_EQ(recalls.size(), 2U) << summary();
  EXPECT_EQ(recalls[0]["agent"], 1);
  EXPECT_FALSE(recalls[0]["sent_out"]);
  EXPECT_TRUE(recalls[1]["sent_out"]);
  const auto rows = recorded_rows(out());
  const auto& [last_tick, last] = *rows.rbegin();
  // The logger may learn of the recall some ticks after the agents.
  EXPECT_LT(recalls[0]["from_tick"].get<Tick>(), last_tick / 2);
  EXPECT_GT(last_tick, 10 * kHeldTick);
  EXPECT_TRUE(last.at(1).stands()) << last.at(1).vx_mps;
  EXPECT_LT(std::hypot(last.at(1).x_m - 2000, last.at(1).y_m), 20);
  EXPECT_FALSE(last.at(0).stands());
  EXPECT_FALSE(std::filesystem::exists(out() / "recalls.json")) << "the summary has them";
  EXPECT_EQ(ergocast({"verify", out()}), 2);
  EXPECT_TRUE(answered("the operator recalled agent 1 at tick ")) << output();
}

/// A team that the test ends, in either pace.
class RecallInEitherPace : public RecallCommand,
                           public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Paces, RecallInEitherPace,
                         ::testing::Values("--lockstep", "--realtime=10"), name_of_pace);

TEST_P(RecallInEitherPace, OutlastsCoordinatorAndAgent) {
  Child mission = launch_endless(scenario(), {GetParam(), "--lcm-url", kUrl});
  ASSERT_EQ(recall({"2"}), 0) << output();
  EXPECT_TRUE(answered("agent 2 is on its way home") || answered("agent 2 rests at home"))
      << output();
  ASSERT_TRUE(eventually([&] { return shown("rests"); })) << output();
  BusObserver observer(kUrl);
  const auto rests = [&](AgentId id) {
    const RosterEntry* const entry = observer.entry(observer.member(id));
    return entry != nullptr && entry->recalled();
  };
  const auto covered = [&](AgentId id) {
    return observer.held(observer.member(id), observer.member(id));
  };
  const auto others_cover = [&](std::int64_t more) {
    std::int64_t before = 0;
    return observer.observes([&] {
      if (before == 0) before = covered(3);
      return before > 0 && covered(3) > before + more;
    });
  };
  ASSERT_TRUE(observer.observes([&] { return rests(2) && covered(2) > 0; })) << printed();
  const std::int64_t at_rest = covered(2);
  ASSERT_TRUE(others_cover(50)) << printed();
  EXPECT_EQ(covered(2), at_rest) << "it covers no more";

  kill_next({"ergocast-coordinator"});
  ASSERT_TRUE(logs("coordinator", "taken over", 1)) << log_of("coordinator");
  ASSERT_TRUE(others_cover(50)) << printed();
  EXPECT_TRUE(rests(2)) << "its successor knows it";
  EXPECT_EQ(covered(2), at_rest);

  const Author former = observer.member(2);
  kill_next(agent(2));
  ASSERT_TRUE(observer.observes([&] {
    const Author now = observer.member(2);
    return now != former && now.incarnation != 0 && observer.answered(now) > 0;
  })) << printed();
  EXPECT_TRUE(rests(2)) << "so does the one that follows it";
  ASSERT_TRUE(others_cover(50)) << printed();
  EXPECT_EQ(covered(2), 0);
  EXPECT_EQ(observer.held(observer.member(3), former), at_rest) << "what it has covered counts";
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_P(RecallInEitherPace, LeavesANumberEmpty) {
  Child mission = launch_endless(scenario(), {GetParam(), "--lcm-url", kUrl});
  ASSERT_EQ(recall({"0", "1", "--leave"}), 0) << output();
  EXPECT_TRUE(answered("agent 0 has left the mission")) << output();
  EXPECT_TRUE(answered("agent 1 has left the mission")) << output();
  ASSERT_TRUE(eventually([&] { return pids(agent(0)).empty() && pids(agent(1)).empty(); }));
  ASSERT_TRUE(moves_on()) << printed();
  EXPECT_EQ(recall({"1"}), 4);
  EXPECT_TRUE(answered("agent 1 has left the mission already")) << output();
  EXPECT_EQ(recall({"7"}), 4);
  EXPECT_TRUE(answered("there is no agent 7: the mission has 2 and 3")) << output();
  EXPECT_EQ(recall({"2", "--leave"}), 0) << output();
  EXPECT_EQ(recall({"3", "--leave"}), 4);
  EXPECT_TRUE(answered("agent 3 is the last one in the mission")) << output();
  EXPECT_EQ(run("ergocast-agent", {"--id", "1", "--lcm-url", kUrl}), 0) << output();
  EXPECT_TRUE(answered("sent out of the mission by the operator")) << output();
  ASSERT_TRUE(moves_on()) << printed();
  for (const int id : {0, 1, 2}) EXPECT_TRUE(pids(agent(id)).empty()) << id;
  EXPECT_FALSE(printed("restarted")) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(RecallCommand, ReportsWhyNobodyIsRecalled) {
  EXPECT_EQ(recall({"1"}), 4);
  EXPECT_TRUE(answered("no message of any run")) << output();
}

}  // namespace
}  // namespace ergocast::test
