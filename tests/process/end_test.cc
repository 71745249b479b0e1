// SPDX-License-Identifier: BSD-3-Clause
// `ergocast amend --end` and `--cancel`: real processes end at the tick that holds, agents are home
// in time, and the simulation of a lockstep mission repeats it.
#include <cmath>

#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"

namespace ergocast::test {
namespace {

class EndCommand : public RunningMission {
 protected:
  int send_command(const std::string& command) { return ergocast({command, "--lcm-url", kUrl}); }
  nlohmann::json status() {
    ergocast({"status", "--json", "--lcm-url", kUrl});
    return nlohmann::json::parse(output());
  }
  /// Whole seconds of mission time.
  int mission_s() { return static_cast<int>(status()["t_s"].get<double>()); }
  /// Pauses the mission, and gives it an end so much later than now; returns that end [s].
  int end_in(int seconds) {
    EXPECT_EQ(send_command("pause"), 0) << output();
    const int end_s = mission_s() + seconds;
    EXPECT_EQ(amend({"--end", std::to_string(end_s) + "s"}), 0) << output();
    return end_s;
  }
  /// Resumes the mission and waits until it has ended by itself.
  void let_end(Child& mission, int end_s) {
    ASSERT_EQ(send_command("resume"), 0) << output();
    EXPECT_EQ(wait_for(mission), 0) << printed();
    const auto summary = this->summary();
    EXPECT_TRUE(summary["reason"].get<std::string>().starts_with("mission complete")) << summary;
    EXPECT_EQ(summary["tick_count"], 10 * end_s);
    EXPECT_EQ(summary["ticks"], 10 * end_s);
  }
  /// Robots with stations, in a mission that does not end by itself.
  std::filesystem::path dusk() const {
    std::string text = text_of(scenario_file("home_by_dusk"));
    text.replace(text.find("time {"), 6, "time { pace: LOCKSTEP lockstep_timeout_s: 600 ");
    std::ofstream(folder_ / "dusk.textproto") << text;
    return folder_ / "dusk.textproto";
  }
};

class EndInEitherPace : public EndCommand, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Paces, EndInEitherPace, ::testing::Values("--lockstep", "--realtime=10"),
                         name_of_pace);

TEST_P(EndInEitherPace, HoldsForAllProcessesAndASuccessorOfTheCoordinator) {
  Child mission = launch_endless(scenario(), {GetParam(), "--lcm-url", kUrl});
  const int first_s = end_in(20);
  EXPECT_TRUE(answered("amendment 1, the end at t = " + std::to_string(first_s) + ".0 s"))
      << output();
  ASSERT_EQ(amend({"--end", "+30s"}), 0) << output();
  EXPECT_TRUE(answered("amendment 2, the end at t = " + std::to_string(first_s + 30) + ".0 s"))
      << output();
  signal_to({"ergocast-coordinator"}, SIGKILL);
  ASSERT_TRUE(eventually([&] { return amend({"--cancel", "2"}) == 0; })) << output();
  EXPECT_TRUE(answered("amendment 3, the end at t = " + std::to_string(first_s) + ".0 s"))
      << output();
  ASSERT_EQ(amend({"--list"}), 0) << output();
  EXPECT_TRUE(answered(" (--cancel undoes it)")) << output();
  const auto shown = status();
  EXPECT_EQ(shown["tick_count"], 10 * first_s);
  EXPECT_EQ(shown["end"]["amendment"], 3);
  let_end(mission, first_s);
  if (HasFatalFailure() || GetParam() != std::string("--lockstep")) return;
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_TRUE(answered("identical to its simulation")) << output();
  EXPECT_EQ(ergocast({"report", out()}), 0) << output();
  EXPECT_EQ(ergocast({"export", out(), "--to", "csv"}), 0) << output();
  const auto file = out() / "amendments.json";
  auto changed = nlohmann::ordered_json::parse(text_of(file));
  changed["amendments"][3]["tick_count"] = 0;
  std::ofstream(file) << changed.dump();
  EXPECT_EQ(ergocast({"verify", out()}), 2);
  EXPECT_TRUE(answered("its end is none of the mission")) << output();
}

TEST_F(EndCommand, IsRefusedIfAnAgentCannotBeHome) {
  Child mission = launch_endless(dusk(), {"--lcm-url", kUrl});
  ASSERT_EQ(send_command("pause"), 0) << output();
  const int now_s = mission_s();
  EXPECT_EQ(amend({"--end", std::to_string(now_s + 13) + "s"}), 4) << output();
  EXPECT_TRUE(answered("cannot be at its station in time")) << output();
  ASSERT_EQ(amend({"--end", std::to_string(now_s + 60) + "s"}), 0) << output();
  let_end(mission, now_s + 60);
  if (HasFatalFailure()) return;
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  const auto rows = recorded_rows(out());
  ASSERT_FALSE(rows.empty());
  for (const auto& [id, one] : rows.rbegin()->second)
    EXPECT_LT(std::hypot(one.x_m - (6 + 8 * id), one.y_m - 4), 1) << id;
}

TEST_F(EndCommand, NamesTheProblemsOfAnEnd) {
  Child mission = launch_endless(scenario(), {"--lcm-url", kUrl});
  ASSERT_EQ(send_command("pause"), 0) << output();
  const auto refuses = [&](std::vector<std::string> arguments, int code, const std::string& why) {
    EXPECT_EQ(amend(std::move(arguments)), code) << output();
    EXPECT_TRUE(answered(why)) << output();
  };
  refuses({"--end", "soon"}, 2, "write 3600s for that mission time, or +600s");
  refuses({"--end", "0s"}, 2, "is no end of this mission");
  refuses({"--end", "+1s"}, 2, "is no end of this mission");
  refuses({"--end", "1s", "--list"}, 2, "--list");
  refuses({"--end", "1s"}, 4, "has passed before all agents can know it");
  refuses({"--end", std::string(kEndless) + "s"}, 4, "already");
  refuses({"--cancel", "0"}, 4, "amendment 0 is a pause: ergocast resume ends it");
  refuses({"--cancel", "7"}, 4, "there is no amendment 7");
  refuses({"--cancel", "abc"}, 2, "\"abc\" is no number of an amendment");
  const int end_s = mission_s() + 5;
  ASSERT_EQ(amend({"--end", std::to_string(end_s) + "s"}), 0) << output();
  refuses({"--end", "+60s"}, 4, "must be named 10 s of mission time before the end that holds");
  let_end(mission, end_s);
}

TEST_F(EndCommand, LetsOneOfTwoOperatorsWin) {
  Child mission = launch_endless(scenario(), {"--lcm-url", kUrl});
  ASSERT_EQ(send_command("pause"), 0) << output();
  const int end_s = mission_s() + 30;
  hold_next("ERGOCAST_AMEND", 0);
  // Both want the same end, and only one of them gets it.
  Child first =
      start("ergocast", {"amend", "--end", std::to_string(end_s) + "s", "--lcm-url", kUrl});
  const auto first_log = log_;
  hold_none();
  ASSERT_TRUE(eventually([&] { return stopped({first.pid()}); })) << text_of(first_log);
  ASSERT_EQ(amend({"--end", std::to_string(end_s) + "s"}), 0) << output();
  first.send(SIGCONT);
  EXPECT_EQ(wait_for(first), 4) << text_of(first_log);
  EXPECT_NE(text_of(first_log).find("another order was first: amendment 1, the end at"),
            std::string::npos)
      << text_of(first_log);
  let_end(mission, end_s);
}

TEST_F(EndCommand, TargetsAreCancelledWhileTheyHoldAndWhileTheyWait) {
  Child mission = launch_endless(scenario(), {"--lcm-url", kUrl});
  std::ofstream(folder_ / "east.textproto")
      << "target { gaussians { mean_x_m: 1600 mean_y_m: 1000 sigma_m: 200 } }";
  const std::string east = folder_ / "east.textproto";
  ASSERT_EQ(amend({"--target", east}), 0) << output();
  ASSERT_EQ(amend({"--cancel", "0"}), 0) << output();
  EXPECT_TRUE(answered("amendment 1, target ")) << output();
  ASSERT_EQ(send_command("pause"), 0) << output();
  Child waits = start("ergocast", {"amend", "--target", east, "--at", "+50s", "--lcm-url", kUrl});
  const auto waits_log = log_;
  ASSERT_TRUE(logs("coordinator", "amendment 3")) << log_of("coordinator");
  Child cancels = start("ergocast", {"amend", "--cancel", "3", "--lcm-url", kUrl});
  ASSERT_TRUE(logs("coordinator", "amendment 4")) << log_of("coordinator");
  Child resumes = start("ergocast", {"resume", "--lcm-url", kUrl});
  EXPECT_EQ(wait_for(waits), 4);
  EXPECT_NE(text_of(waits_log).find("never holds: amendment 4 replaced it"), std::string::npos)
      << text_of(waits_log);
  EXPECT_EQ(wait_for(cancels), 0);
  EXPECT_EQ(wait_for(resumes), 0);
  EXPECT_EQ(amend({"--cancel", "3"}), 4) << output();
  EXPECT_TRUE(answered("a later amendment has replaced amendment 3")) << output();
  EXPECT_EQ(amend({"--list"}), 0) << output();
  EXPECT_TRUE(answered(", held from tick ")) << output();
  EXPECT_TRUE(answered(", never holds: amendment 4 replaced it before tick ")) << output();
  ASSERT_TRUE(moves_on());
  ASSERT_EQ(send_command("stop"), 0) << output();
  ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
  const auto all = summary()["amendments"];
  ASSERT_EQ(all.size(), 6U);
  EXPECT_EQ(all[3]["from_tick"], all[4]["from_tick"]) << "amendment 3 never held";
  EXPECT_EQ(summary()["targets"].size(), 4U) << "the plan's, and amendments 0, 1 and 4";
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
}

TEST_F(EndCommand, IsRehearsedInASimulation) {
  const auto rehearse = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"simulate", scenario(), "--duration", "200", "--out", out()});
    return ergocast(more);
  };
  EXPECT_EQ(rehearse({"--end", "60:+50s", "--end", "100:220s"}), 0) << output();
  EXPECT_TRUE(answered("\n  end       amendment 0 at t = 250.0 s, from t = 60.0 s on\n"))
      << output();
  EXPECT_EQ(summary()["ticks"], 2200);
  EXPECT_EQ(summary()["amendments"].size(), 2U);
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  for (const auto& [wrong, why] :
       {std::pair("60", "is not T:TIME"), std::pair("300:+50s", "the mission has ended then"),
        std::pair("60:50s", "that end is before it is named"),
        std::pair("195:+50s", "must be named 10 s before"),
        std::pair("60:200s", "ends then already")}) {
    EXPECT_EQ(rehearse({"--end", wrong}), 2) << output();
    EXPECT_TRUE(answered(why)) << output();
  }
}

}  // namespace
}  // namespace ergocast::test
