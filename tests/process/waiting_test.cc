// SPDX-License-Identifier: BSD-3-Clause
// The waits of tests end with the process that they wait for, and only with that one.
#include "tests/process/support/waiting.h"

#include <gtest/gtest-spi.h>

#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

class Waiting : public ByHand {
 protected:
  /// The failures that a wait reports, which are no failures of this test.
  static std::string failures_of(const std::function<bool()>& wait) {
    using Reporter = ::testing::ScopedFakeTestPartResultReporter;
    ::testing::TestPartResultArray failures;
    bool has_happened = true;
    {
      const Reporter reporter(Reporter::INTERCEPT_ONLY_CURRENT_THREAD, &failures);
      has_happened = wait();
    }
    EXPECT_FALSE(has_happened);
    std::string text;
    for (int i = 0; i < failures.size(); ++i) {
      text += failures.GetTestPartResult(i).message() + std::string("\n");
    }
    return text;
  }
  /// A wait for an event that comes after many checks.
  static bool wait_long() {
    int looks = 0;
    return eventually([&looks] { return ++looks > 50; });
  }
  static void expect_parts(const std::string& text, const std::vector<std::string>& parts) {
    for (const std::string& part : parts) EXPECT_NE(text.find(part), text.npos) << part << text;
  }
  /// A child that has ended, not yet seen by the test.
  void start_and_let_end(const std::string& program, const std::vector<std::string>& arguments) {
    const Child child = start(program, arguments);
    siginfo_t ignored;
    waitid(P_PID, static_cast<id_t>(child.pid()), &ignored, WEXITED | WNOWAIT);
  }
};

TEST_F(Waiting, EndsAtOnceWithTheOutputOfAProgramThatFails) {
  hand("ergocast-agent");
  start("ergocast-logger", {"--no-such-option"});
  const std::string printed = failures_of([this] { return recorded(1); });
  expect_parts(printed,
               {"/ergocast-logger --no-such-option\nexited with code 2 while the test waited",
                "there is no option --no-such-option; --help lists what there is"});
  EXPECT_EQ(failures_of([this] { return recorded(1); }), "") << "it is reported once";
}

TEST_F(Waiting, ForAnotherProcessEndsAtOnceToo) {
  Program& coordinator = hand("ergocast-coordinator", {scenario()});
  hand("ergocast-agent", {"--id", "none"});
  const std::string printed =
      failures_of([&] { return wait_for(coordinator.child) >= 0; });  // it waits for its team
  expect_parts(printed, {"/ergocast-agent --id none", "exited with code 2 while the test waited"});
}

TEST_F(Waiting, ForAProgramsOutputEndsWithIt) {
  hand("ergocast-agent");
  Program& told = hand("ergocast", {"doctor", "--help"});
  expect_parts(failures_of([&] { return told.prints("what it never prints"); }),
               {"/ergocast doctor --help", "exited with code 0 while the test waited"});
}

TEST_F(Waiting, EndsWhenNothingRunsAnyMore) {
  start("ergocast", {"--version"});
  expect_parts(failures_of([this] { return recorded(1); }),
               {"/ergocast --version\nexited with code 0 while the test waited"});
}

TEST_F(Waiting, GoesOnWhenAProgramEndsAsTheTestWants) {
  hand("ergocast-agent");
  Child killed = start("ergocast-agent", {"--lcm-url", kUrl});
  killed.send(SIGKILL);
  start_and_let_end("ergocast", {"--version"});
  EXPECT_EQ(run("ergocast", {"--no-such-option"}), 2) << "an end that the test has seen";
  EXPECT_TRUE(wait_long());
}

TEST_F(Waiting, HasWhatItWaitsForAlthoughThatWasTheLastDeedOfAProgram) {
  start_and_let_end("ergocast", {"--no-such-option"});
  EXPECT_TRUE(
      eventually([this] { return output().find("--no-such-option") != std::string::npos; }));
}

}  // namespace
}  // namespace ergocast::test
