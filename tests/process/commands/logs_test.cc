// SPDX-License-Identifier: BSD-3-Clause
// A failed test of processes prints their logs and ends them.
#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

/// Set in the process in which the failure is planted.
constexpr const char* kPlanted = "ERGOCAST_PLANTED_FAILURE";

using FailedTest = ByHand;

TEST_F(FailedTest, PrintsTheLogsOfItsProcessesAndEndsThem) {
  if (std::getenv(kPlanted) != nullptr) {
    hand("ergocast-agent", {"--id", "7"});
    const Child mission = launch_endless(scenario());
    EXPECT_GT(mission.pid(), 0);
    FAIL() << "planted";
  }
  setenv(kPlanted, "1", 1);
  const auto log = folder_ / "planted";
  Child planted =
      Child::start(
          {{"/proc/self/exe", "--gtest_filter=FailedTest.PrintsTheLogsOfItsProcessesAndEndsThem"},
           log,
           SIGKILL})
          .value();
  unsetenv(kPlanted);
  EXPECT_EQ(wait_for(planted), 1);
  const std::string printed = text_of(log);
  for (const char* part :
       {"---- the end of output-1 (ergocast-agent --id 7 --lcm-url ", "agent-7: joining on ",
        "---- the end of output-2 (ergocast run ", "---- the end of run/log/agent-0.log:\n",
        "agent-3: agent 3 of run ", "coordinator: mission running", "sim: moving from tick 0 on",
        "---- the end of run/log/logger.log:\n"}) {
    EXPECT_NE(printed.find(part), printed.npos) << part;
  }
  EXPECT_EQ(printed.find("left behind"), printed.npos);
  if (HasFailure()) std::printf("%s", printed.c_str());
}

}  // namespace
}  // namespace ergocast::test
