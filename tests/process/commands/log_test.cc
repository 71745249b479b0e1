// SPDX-License-Identifier: BSD-3-Clause
// The logs of the programs: their amount, and their format in the journal.
#include <sys/stat.h>

#include <cstdlib>
#include <sstream>

#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

class Log : public ByHand {
 protected:
  void TearDown() override {
    unsetenv("ERGOCAST_LOG_LEVEL");
    unsetenv("JOURNAL_STREAM");
    ByHand::TearDown();
  }
  static bool has(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  }
};

TEST_F(Log, KeepsToItsLevel) {
  Program& quiet = hand("ergocast-agent", {"--log-level", "warn"});
  ASSERT_TRUE(quiet.prints("warning agent: no coordinator answers")) << quiet.printed();
  EXPECT_FALSE(has(quiet.printed(), "joining on")) << quiet.printed();
}

TEST_F(Log, TakesItsLevelFromTheEnvironmentUnlessTheCommandLineHasOne) {
  setenv("ERGOCAST_LOG_LEVEL", "error", 1);
  Program& silent = hand("ergocast-agent");
  Program& told = hand("ergocast-agent", {"--log-level", "info"});
  ASSERT_TRUE(told.prints("no coordinator answers")) << told.printed();
  EXPECT_TRUE(has(told.printed(), "info agent: joining on")) << told.printed();
  EXPECT_EQ(silent.printed(), "");
}

TEST_F(Log, RefusesALevelThatIsNone) {
  EXPECT_EQ(run("ergocast-sim", {"--log-level", "loud"}), 2);
  EXPECT_TRUE(has(output(), "trace")) << output();
  setenv("ERGOCAST_LOG_LEVEL", "loud", 1);
  EXPECT_EQ(run("ergocast-sim", {}), 2);
  EXPECT_TRUE(has(output(), "loud not in {trace,debug,info,warn,error}")) << output();
}

TEST_F(Log, InTheJournalHasAPriorityOnEveryLineAndNoTimeOfItsOwn) {
  const auto journal = folder_ / "output-1";  // the first program's output
  std::ofstream(journal).close();
  struct stat info {};
  ASSERT_EQ(stat(journal.c_str(), &info), 0);
  setenv("JOURNAL_STREAM",
         (std::to_string(info.st_dev) + ':' + std::to_string(info.st_ino)).c_str(), 1);
  ASSERT_EQ(std::system("ip route del 224.0.0.0/4 dev lo"), 0);
  EXPECT_EQ(run("ergocast-sim", {}), 3);
  const std::string printed = output();
  EXPECT_EQ(run("ergocast-sim", {}), 3);
  EXPECT_TRUE(has(output(), " error sim: ")) << "another file is no journal";
  ASSERT_EQ(std::system("ip route add 224.0.0.0/4 dev lo"), 0);
  EXPECT_TRUE(has(printed, "<3>sim:   ip route add 224.0.0.0/4 dev lo")) << printed;
  std::istringstream lines(printed);
  for (std::string line; std::getline(lines, line);) {
    EXPECT_TRUE(line.starts_with("<3>sim: ")) << line;
  }
}

}  // namespace
}  // namespace ergocast::test
