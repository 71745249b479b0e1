#include "logger/summary.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/support/team.h"

namespace ergocast::test {
namespace {

TEST(Summary, IsWrittenWhateverBytesTheNetworkBrought) {
  std::ostringstream trajectory, metrics;
  Recorder recorder(kRun, kLoggerLife, decoder_of(small_mission(1)), trajectory, metrics);
  recorder.receive(mission_part(1, MissionState::kRunning, roster_of(1)), at(0s));
  recorder.receive(Stop{{kRun, kOperator, 1, 1, 0}, true, "caf\xe9"}, at(0s));
  const auto read = nlohmann::json::parse(to_text(summarize(recorder, {})));
  EXPECT_EQ(read["result"], "failed");
  EXPECT_EQ(read["reason"], "caf\xef\xbf\xbd") << "the replacement character";
}

TEST(Summary, SaysNothingOfWhatIsNotKnown) {
  std::ostringstream trajectory, metrics;
  const Recorder recorder(kRun, kLoggerLife, decoder_of(small_mission(1)), trajectory, metrics);
  const auto summary = summarize(recorder, {});
  EXPECT_EQ(summary["result"], "stopped");
  EXPECT_EQ(summary["ticks"], 0);
  EXPECT_TRUE(summary["ergodic_metric"]["first"].is_null());
  EXPECT_TRUE(summary["log_log_slope"].is_null());
  EXPECT_TRUE(summary["ticks_per_s"].is_null());
  EXPECT_TRUE(summary["agents"].empty());
}

}  // namespace
}  // namespace ergocast::test
