// SPDX-License-Identifier: BSD-3-Clause
// A team that finds: real processes find what their simulation finds, also after kills, and say so.
#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

class FindingObjects : public RunningMission {
 protected:
  static constexpr const char* kObjects = "world.objects.count=6";
  static constexpr const char* kRadius = "sensor.radius_m=150";

  /// The finds of the same mission as one process simulates it.
  nlohmann::json simulated(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"simulate", scenario(), "--out", folder_ / "simulated"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(ergocast(words), 0) << output();
    return nlohmann::json::parse(text_of(folder_ / "simulated" / "summary.json"))["objects"];
  }
};

TEST_F(FindingObjects, FindTheSameAsTheSimulation) {
  const std::vector<std::string> set{"--set", kObjects, "--set", kRadius, "--duration", "120"};
  const auto objects = simulated(set);
  EXPECT_EQ(objects["count"], 6);
  const int found = objects["found"];
  EXPECT_GT(found, 0);
  EXPECT_EQ(objects["finds"].size(), objects["found"]);
  const std::string line = "found by agent " + objects["finds"][0]["agent"].dump() + " at (";
  const std::string end = "found " + std::to_string(found) + " of 6 objects";
  for (const std::string& part : {line, end})
    EXPECT_NE(output().find(part), std::string::npos) << part << '\n' << output();

  std::vector<std::string> words{"run", scenario(), "--lockstep", "--out", out()};
  words.insert(words.end(), set.begin(), set.end());
  ASSERT_EQ(ergocast(words), 0) << output();
  EXPECT_NE(output().find(end), std::string::npos) << output();
  EXPECT_EQ(summary()["objects"], objects);
  for (const auto& find : objects["finds"]) {  // on the terminal, as they happen
    const std::string told =
        "object " + find["object"].dump() + " found by agent " + find["agent"].dump() + " at (";
    const std::string said = output().substr(0, output().find(end));
    EXPECT_NE(said.find(told), std::string::npos) << told << '\n' << said;
  }
  EXPECT_NE(log_of("logger").find(line), std::string::npos) << log_of("logger");
  EXPECT_NE(log_of("logger").find(end), std::string::npos) << log_of("logger");
  EXPECT_EQ(text_of(out() / "trajectory.csv"), text_of(folder_ / "simulated" / "trajectory.csv"));
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_NE(text_of(out() / "scenario.textproto").find("objects"), std::string::npos);
}

/// A restarted world detects the same again, and a restarted logger knows the earlier finds.
TEST_F(FindingObjects, AreFoundOnceInSpiteOfKills) {
  const std::vector<std::string> set{"--set", kObjects, "--set", kRadius};
  const auto objects = simulated(set);
  EXPECT_GT(objects["found"].get<int>(), 2);
  Child mission = launch_held(scenario(), {"--lockstep", "--set", kObjects, "--set", kRadius});
  kill_next({"ergocast-logger"});
  kill_next({"ergocast-sim"});
  release();
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["restarts"], 2);
  EXPECT_EQ(summary()["objects"], objects);
}

/// They drift: real processes find what one process finds, also after the world was replaced.
TEST_F(FindingObjects, ThatDrift) {
  const std::vector<std::string> set{"--set", kObjects, "--set",
                                     kRadius, "--set",  "world.objects.motion.speed_mps=6"};
  const auto objects = simulated(set);
  EXPECT_GT(objects["found"].get<int>(), 2);
  std::vector<std::string> words{"--lockstep"};
  words.insert(words.end(), set.begin(), set.end());
  Child mission = launch_held(scenario(), words);
  kill_next({"ergocast-sim"});
  release();
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["restarts"], 1);
  EXPECT_EQ(summary()["objects"], objects);
  EXPECT_EQ(text_of(out() / "trajectory.csv"), text_of(folder_ / "simulated" / "trajectory.csv"));
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_NE(text_of(out() / "scenario.textproto").find("speed_mps: 6"), std::string::npos);
  const std::string drifts = "drift at 6 m/s, persistence 60 s";
  EXPECT_NE(text_of(out() / "report.html").find(drifts), std::string::npos);

  // At the same places, objects that stand still are found at other times.
  std::vector<std::string> still = set;
  still.resize(4);
  std::filesystem::remove_all(folder_ / "simulated");
  EXPECT_NE(simulated(still)["finds"], objects["finds"]);
}

/// The end is named at the same tick as in one process, and the record repeats.
TEST_F(FindingObjects, EndTheMissionIfThatIsWanted) {
  const std::vector<std::string> set{"--set", kObjects, "--set", "world.objects.end_when_found=2",
                                     "--set", kRadius};
  const auto objects = simulated(set);
  EXPECT_EQ(objects["found"], 2);
  ASSERT_EQ(ergocast({"keygen", folder_ / "team"}), 0) << output();
  std::vector<std::string> words{"run", scenario(), "--lockstep", "--out", out()};
  words.insert(words.end(), set.begin(), set.end());
  EXPECT_EQ(ergocast(words), 2) << "without a key";
  EXPECT_NE(output().find("without a key any program"), std::string::npos) << output();
  words.insert(words.end(), {"--key-file", folder_ / "team.coordinator.key"});
  ASSERT_EQ(ergocast(words), 0) << output();
  EXPECT_NE(output().find("2 of 6 objects are found"), std::string::npos) << output();
  EXPECT_EQ(summary()["objects"], objects);
  EXPECT_EQ(summary()["amendments"][0]["by"], "finding");
  EXPECT_EQ(text_of(out() / "trajectory.csv"), text_of(folder_ / "simulated" / "trajectory.csv"));
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();
  EXPECT_EQ(ergocast({"verify", folder_ / "simulated"}), 0) << output();
}

/// Reports reach agents and record, also after kills, and objects count once reports confirm them.
TEST_F(FindingObjects, ConfirmThemWhenSensorsHaveFalseAlarms) {
  const std::vector<std::string> set{"--set", kObjects,
                                     "--set", kRadius,
                                     "--set", "law.kind=SEARCH",
                                     "--set", "sensor.false_alarms_per_s=0.05",
                                     "--set", "sensor.position_error_m=20"};
  const auto objects = simulated(set);
  EXPECT_GT(objects["found"].get<int>(), 0);
  const auto alone = nlohmann::json::parse(text_of(folder_ / "simulated" / "summary.json"));
  EXPECT_GE(alone["wrong_confirmations"], 0);
  const std::string rows = text_of(folder_ / "simulated" / "trajectory.csv");
  EXPECT_NE(rows.find(",detected,reported\n"), std::string::npos);
  EXPECT_NE(rows.find(",0,-1\n"), std::string::npos);

  std::vector<std::string> words{"--lockstep"};
  words.insert(words.end(), set.begin(), set.end());
  Child mission = launch_held(scenario(), words);
  kill_next({"ergocast-logger"});
  kill_next({"ergocast-sim"});
  release();
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["restarts"], 2);
  EXPECT_EQ(summary()["objects"], objects);
  EXPECT_EQ(summary()["wrong_confirmations"], alone["wrong_confirmations"]);
  EXPECT_EQ(ergocast({"verify", out()}), 0) << output();

  // A detection alone is no find.
  std::vector<std::string> certain = set;
  certain[7] = "sensor.false_alarms_per_s=0";
  std::filesystem::remove_all(folder_ / "simulated");
  const auto detected = simulated(certain);
  EXPECT_LE(detected["finds"][0]["tick"], objects["finds"][0]["tick"]);
}

TEST_F(FindingObjects, WithoutObjectsNothingIsSaid) {
  ASSERT_EQ(ergocast({"simulate", scenario(), "--duration", "20", "--out", out()}), 0) << output();
  EXPECT_FALSE(summary().contains("objects"));
  EXPECT_EQ(text_of(out() / "trajectory.csv").find("detected"), std::string::npos);
}

}  // namespace
}  // namespace ergocast::test
