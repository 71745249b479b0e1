// SPDX-License-Identifier: BSD-3-Clause
// --set: the mission that runs, is checked and is recorded has the set fields.
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

class Set : public OwnHost {
 protected:
  bool printed(const std::string& part) const { return output().find(part) != std::string::npos; }
  /// The hash of the plan that `check` prints.
  std::string plan(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "check");
    EXPECT_EQ(ergocast(std::move(arguments)), 0) << output();
    const std::string text = output();
    const auto at = text.find("plan ");
    return at == std::string::npos ? "" : text.substr(at, text.find(" (", at) - at);
  }

  const std::string scenario_ = scenario_file("quadrimodal_corners");
  const std::vector<std::string> options_{
      "--set", "law.epsilon=0.3", "--set", "agents.starts[1].x_m=33", "--duration", "20"};
};

TEST_F(Set, TheRecordHasTheScenarioThatRan) {
  auto words = options_;
  words.insert(words.begin(), scenario_);
  const std::string wanted = plan(words);
  EXPECT_NE(wanted, plan({scenario_, "--duration", "20"}));
  for (const char* command : {"run", "simulate"}) {
    auto line = words;
    line.insert(line.begin(), command);
    const auto folder = folder_ / (std::string(command) + "-record");
    line.insert(line.end(), {"--out", folder});
    ASSERT_EQ(ergocast(line), 0) << output();
    const std::string copy = text_of(folder / "scenario.textproto");
    EXPECT_NE(copy.find("  epsilon: 0.3\n"), std::string::npos) << copy;
    EXPECT_EQ(plan({folder / "scenario.textproto"}), wanted);
    EXPECT_EQ(ergocast({"verify", folder}), 0) << output();
  }
  EXPECT_EQ(text_of(folder_ / "run-record" / "trajectory.csv"),
            text_of(folder_ / "simulate-record" / "trajectory.csv"));
}

TEST_F(Set, ChecksAllFieldsAtOnceBeforeAnythingIsWritten) {
  for (const char* command : {"run", "simulate", "check"}) {
    std::vector<std::string> words{command, scenario_,         "--set",  "law.epsilom=0.3",
                                   "--set", "law.epsilon=-1",  "--set",  "seed=4",
                                   "--set", "agents.quorum=x", "--seed", "3"};
    if (command != std::string("check")) words.insert(words.end(), {"--out", out()});
    EXPECT_EQ(ergocast(words), 2);
    EXPECT_TRUE(
        printed("--set law.epsilom=0.3: unknown field \"epsilom\" in Law (did you mean "
                "law.epsilon?)\n"))
        << output();
    EXPECT_TRUE(printed("--set law.epsilon=-1: -1 is below the limit 0")) << output();
    EXPECT_TRUE(printed("--set seed=4: --seed sets it too (leave out one of them)\n")) << output();
    EXPECT_TRUE(printed("--set agents.quorum=x: x is not a whole number")) << output();
    EXPECT_TRUE(printed("\n4 problems\n")) << output();
    EXPECT_FALSE(std::filesystem::exists(out()));
  }
  EXPECT_EQ(ergocast({"check", scenario_, "--set", "=3"}), 2);
  EXPECT_TRUE(printed("--set: \"=3\" is not FIELD=VALUE")) << output();
  EXPECT_EQ(ergocast({"simulate", scenario_, "--seeds", "1:3", "--set", "seed=4"}), 2);
  EXPECT_TRUE(printed("--set seed=4: --seeds sets it too")) << output();
}

}  // namespace
}  // namespace ergocast::test
