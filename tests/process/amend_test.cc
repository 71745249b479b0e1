// SPDX-License-Identifier: BSD-3-Clause
// `ergocast amend`: real processes cover another target in flight. Targets with problems, other
// operators and recordings change nothing.
#include "runtime/process/key_file.h"
#include "tests/process/support/mission.h"
#include "tests/process/support/record.h"
#include "tests/process/support/replayer.h"

namespace ergocast::test {
namespace {

class AmendCommand : public RunningMission {
 protected:
  static std::string gaussian_at(int x_m) {
    return "target { gaussians { mean_x_m: " + std::to_string(x_m) +
           " mean_y_m: 1000 sigma_m: 200 } }\n";
  }
  std::filesystem::path file(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return folder_ / name;
  }
  /// The default scenario with fast vehicles, and a target in the west.
  std::filesystem::path west() {
    const auto path = scenario();
    std::string text = text_of(path);
    const auto begin = text.find("target {");
    text.replace(begin, text.find("\n}\n", begin) + 3 - begin, gaussian_at(400));
    text.replace(text.find("u_max_mps: 20"), 13, "u_max_mps: 60");
    std::ofstream(path) << text;
    return path;
  }
  std::filesystem::path east() const { return file("east.textproto", gaussian_at(1600)); }

  /// The share of rows in the eastern half, from that tick on.
  double share_in_the_east(Tick from) const {
    double all = 0, east = 0;
    for (const auto& [tick, row] : recorded_rows(out())) {
      if (tick < from) continue;
      for (const auto& [id, one] : row) {
        ++all;
        if (one.x_m > 1000) ++east;
      }
    }
    EXPECT_GT(all, 1000);
    return east / all;
  }
};

/// A team in either pace.
class AmendInEitherPace : public AmendCommand, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Paces, AmendInEitherPace, ::testing::Values("--lockstep", "--realtime=10"),
                         name_of_pace);

TEST_P(AmendInEitherPace, GivesTheTeamANewTarget) {
  Child mission = launch_endless(west(), {GetParam(), "--lcm-url", kUrl});
  ASSERT_EQ(amend({"--list"}), 0) << output();
  EXPECT_TRUE(answered("no amendments: the mission is as its plan has it")) << output();
  ASSERT_EQ(amend({"--target", east(), "--at", "+3s"}), 0) << output();
  EXPECT_TRUE(answered("amendment 0, target ")) << output();
  const Tick from = since_tick();
  ASSERT_TRUE(logs("coordinator", "amendment 0")) << log_of("coordinator");
  // A mission that has moved on has covered the new target for long.
  ASSERT_TRUE(moves_on(400000)) << printed();
  ASSERT_EQ(amend({"--list"}), 0) << output();
  EXPECT_TRUE(answered("holds since tick " + std::to_string(from) + ", ")) << output();
  ASSERT_EQ(ergocast({"stop", "--lcm-url", kUrl}), 0) << output();
  ASSERT_TRUE(eventually([&] { return !mission.running(); })) << printed();
  EXPECT_EQ(mission.exit_code(), 0) << printed();
  EXPECT_GT(share_in_the_east(from + 500), 0.8);
}

TEST_F(AmendCommand, ShowsWhatWouldChangeAndSendsNothing) {
  Child mission = launch_held(west(), {"--lcm-url", kUrl});
  Replayer ear(LcmUrl::parse(kUrl).value(), "AMEND");
  ASSERT_EQ(amend({"--target", east(), "--dry-run"}), 0) << output();
  EXPECT_TRUE(answered("about 100 % of its mass is elsewhere")) << output();
  EXPECT_TRUE(answered("it would be amendment 0, at the earliest from tick ")) << output();
  // The scenario in the run's directory with another mean.
  ASSERT_EQ(amend({"--set", "target.gaussians[0].mean_x_m=400", "--dry-run"}), 0) << output();
  EXPECT_TRUE(answered("about 0 % of its mass is elsewhere")) << output();
  ASSERT_EQ(amend({"--target", file("map.csv", "0,1\n"), "--dry-run"}), 0) << output();
  ear.listen();
  EXPECT_EQ(ear.kept(), 0U);
  ASSERT_EQ(amend({"--list"}), 0) << output();
  EXPECT_TRUE(answered("no amendments")) << output();
  release();
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(AmendCommand, NamesTheProblemsOfATarget) {
  Child mission = launch_held(west(), {"--lcm-url", kUrl});
  const auto refuses = [&](std::vector<std::string> arguments, const std::string& why) {
    EXPECT_EQ(amend(std::move(arguments)), 2) << output();
    EXPECT_TRUE(answered(why)) << output();
  };
  refuses({}, "--target, --set, --zone, --law, --sighting, --dismiss, --end, --cancel or --list");
  refuses({"--target", "none.csv"}, "there is no such file");
  refuses({"--target", "lake_search"}, "domain: has ");
  refuses({"--target", file("far.textproto", gaussian_at(90000))}, "far.textproto:1:1: target: ");
  refuses({"--target", file("typo.textproto", "target { gaussian { } }")}, "did you mean");
  refuses({"--target", file("map.tif", "II")}, "needs to know where on the earth");
  refuses({"--target", file("map.png", "no picture")}, "map.png");
  refuses({"--target", east(), "--at", "10"}, "write +10s");
  refuses({"--target", east(), "--list"}, "--list");
  refuses({"--set", "law.u_max_mps=3"}, "only the target of a running mission can change");
  EXPECT_EQ(amend({"--target", east(), "--at", "+1000s"}), 4) << output();
  EXPECT_TRUE(answered("the mission ends before that, at tick ")) << output();
  release();
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(AmendCommand, LetsOneOfTwoOperatorsWin) {
  Child mission = launch_endless(west(), {"--lcm-url", kUrl});
  hold_next("ERGOCAST_AMEND", 0);  // the first operator, once it knows the mission
  Child first = start("ergocast", {"amend", "--target", east(), "--lcm-url", kUrl});
  const auto first_log = log_;
  hold_none();
  ASSERT_TRUE(eventually([&] { return stopped({first.pid()}); })) << text_of(first_log);
  ASSERT_EQ(amend({"--target", file("middle.textproto", gaussian_at(1000))}), 0) << output();
  first.send(SIGCONT);
  EXPECT_EQ(wait_for(first), 4) << text_of(first_log);
  EXPECT_NE(text_of(first_log).find("another order was first: amendment 0, target "),
            std::string::npos)
      << text_of(first_log);
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(AmendCommand, HasNoEffectWhenItIsRecordedAndRepeated) {
  Child mission = launch_endless(west(), {"--lcm-url", kUrl});
  // In a pause there are few messages, and the attacker receives all of them.
  ASSERT_EQ(ergocast({"pause", "--lcm-url", kUrl}), 0) << output();
  Replayer attacker(LcmUrl::parse(kUrl).value(), "AMEND");
  ASSERT_EQ(amend({"--target", east()}), 0) << output();
  attacker.listen();
  ASSERT_GT(attacker.kept(), 0U);
  attacker.replay(10 * attacker.kept());
  // The coordinator reads this order after the repeated ones.
  ASSERT_EQ(ergocast({"resume", "--lcm-url", kUrl}), 0) << output();
  ASSERT_EQ(amend({"--list"}), 0) << output();
  EXPECT_TRUE(answered("amendment 1, target ")) << output();
  EXPECT_TRUE(answered("amendment 2, ")) << output();
  EXPECT_FALSE(answered("amendment 3")) << output();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(AmendCommand, NeedsTheKeyOfTheCoordinator) {
  const MissionKey key = make_mission_key();
  const std::string coordinator = folder_ / "c.key", team = folder_ / "t.key";
  ASSERT_EQ(write_key_file(coordinator, key_text(key, true)), std::nullopt);
  ASSERT_EQ(write_key_file(team, key_text(key, false)), std::nullopt);
  Child mission = launch_endless(west(), {"--key-file", coordinator, "--lcm-url", kUrl});
  EXPECT_EQ(amend({"--target", east()}), 4) << output();
  EXPECT_TRUE(answered("--key-file")) << output();
  EXPECT_EQ(amend({"--target", east(), "--key-file", team}), 2) << output();
  EXPECT_EQ(amend({"--target", east(), "--key-file", coordinator}), 0) << output();
  EXPECT_TRUE(answered("amendment 0, target ")) << output();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

TEST_F(AmendCommand, IsRehearsedInASimulation) {
  const auto scenario = west();
  const auto rehearse = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"simulate", scenario, "--duration", "200", "--out", out()});
    return ergocast(more);
  };
  EXPECT_EQ(rehearse({"--amend", "60:" + east().string(), "--amend",
                      "20:" + file("middle.textproto", gaussian_at(1000)).string()}),
            0)
      << output();
  EXPECT_TRUE(answered("\n  target    amendment 1 from t = 60.0 s on\n")) << output();
  EXPECT_GT(share_in_the_east(1100), 0.8);
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  for (const auto& [wrong, why] :
       {std::pair("60", "is not T:FILE"), std::pair("60+0:a", "a zone lasts for TIME above 0"),
        std::pair("300:lake_search", "the mission has ended then"),
        std::pair("60:lake_search", "domain: has ")}) {
    EXPECT_EQ(rehearse({"--amend", wrong}), 2) << output();
    EXPECT_TRUE(answered(why)) << output();
  }
  EXPECT_EQ(ergocast({"simulate", scenario, "--seeds", "1:2", "--amend", "60:lake_search"}), 2);
}

TEST_F(AmendCommand, ReportsWhyThereIsNoTeam) {
  EXPECT_EQ(amend({"--list"}), 4);
  EXPECT_TRUE(answered("no message of any run")) << output();
}

}  // namespace
}  // namespace ergocast::test
