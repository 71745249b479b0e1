// SPDX-License-Identifier: BSD-3-Clause
// Files of the run directory, and the key file, are removed, cut or overwritten during a mission.
// Only the file itself is lost. The mission continues, also with restarted processes.
#include <filesystem>

#include "runtime/process/key_file.h"
#include "tests/process/support/bus_observer.h"
#include "tests/process/support/free_rooms.h"
#include "tests/process/support/mission.h"

namespace ergocast::test {
namespace {

namespace fs = std::filesystem;

enum class Harm { kRemoved, kCut, kOverwritten };

/// A file that is being written under a temporary name may be gone already.
void harm(const fs::path& file, Harm how) {
  std::error_code gone;
  const std::uintmax_t bytes = fs::file_size(file, gone);
  if (gone) return;
  if (how == Harm::kRemoved) fs::remove(file, gone);
  if (how == Harm::kCut) fs::resize_file(file, bytes / 2, gone);
  if (how == Harm::kOverwritten) {  // in place, as `cp` does
    std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
    stream << std::string(bytes, '~');
  }
}

class LostFiles : public RunningMission {
 protected:
  /// Every file of the run directory but the summary, which is written at the end.
  std::vector<fs::path> files() const {
    std::vector<fs::path> found;
    std::error_code gone;
    for (const auto& entry : fs::recursive_directory_iterator(out())) {
      if (entry.is_regular_file(gone)) found.push_back(entry.path());
    }
    return found;
  }
  void restart(const std::vector<std::string>& words, const std::string& name) {
    kill_next(words);
    ASSERT_TRUE(eventually([&] { return printed(name + ": restarted (1 of 3)"); })) << printed();
  }
};

class HarmedFiles : public LostFiles, public ::testing::WithParamInterface<Harm> {};
std::string harm_name(const ::testing::TestParamInfo<Harm>& how) {
  constexpr const char* kNames[] = {"Removed", "Cut", "Overwritten"};
  return kNames[static_cast<int>(how.param)];
}
INSTANTIATE_TEST_SUITE_P(Of, HarmedFiles,
                         ::testing::Values(Harm::kRemoved, Harm::kCut, Harm::kOverwritten),
                         harm_name);

TEST_P(HarmedFiles, AreAllThatIsLostWhicheverProcessStartsAgain) {
  Child mission = launch_endless(free_rooms(folder_), {"--lcm-url", kUrl});
  // In lockstep the record continues with all processes or not at all. Its files are gone.
  BusObserver observer(kUrl);
  ASSERT_TRUE(observer.observes([&] { return observer.recorded() >= 0; })) << printed();
  for (const auto& [name, words] :
       {std::pair{"logger", std::vector<std::string>{"ergocast-logger"}},
        std::pair{"sim", std::vector<std::string>{"ergocast-sim"}},
        std::pair{"coordinator", std::vector<std::string>{"ergocast-coordinator"}},
        std::pair{"agent-1", agent(1)}}) {
    for (const fs::path& file : files()) harm(file, GetParam());
    restart(words, name);
    const Tick tick = observer.recorded();
    ASSERT_TRUE(observer.observes([&] { return observer.recorded() > tick + 200; })) << printed();
  }
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["result"], "stopped");
  EXPECT_EQ(summary()["restarts"], 4) << printed();
  EXPECT_TRUE(summary()["ergodic_metric"]["last"].is_number()) << summary()["ergodic_metric"];
}

TEST_P(HarmedFiles, DisturbNoProcessThatRuns) {
  Child mission = launch_held(free_rooms(folder_));
  for (const fs::path& file : files()) harm(file, GetParam());
  release();
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["result"], "done");
  EXPECT_EQ(summary()["restarts"], 0) << printed();
  EXPECT_TRUE(summary()["ergodic_metric"]["last"].is_number()) << summary()["ergodic_metric"];
  EXPECT_TRUE(printed("no report: ") || fs::exists(out() / "report.html")) << printed();
}

// Files that a scenario names, such as maps, may be gone as well.
TEST_F(LostFiles, WithoutTheScenarioAndItsMapTheNextCoordinatorBeginsTheMission) {
  const fs::path shipped = scenario_file("lake_search").parent_path();
  fs::copy(shipped / "maps", folder_ / "maps");
  fs::copy(shipped / "lake_search.textproto", folder_);
  hold_next("ERGOCAST_MISSION", -1);  // the coordinator, before its first message
  Child mission = start_mission(folder_ / "lake_search.textproto", {"--duration", "10"});
  const std::vector<std::string> coordinator{"ergocast-coordinator"};
  ASSERT_TRUE(eventually([&] { return stopped(pids(coordinator)); })) << printed();
  hold_none();
  fs::remove_all(folder_ / "maps");
  fs::remove(out() / "scenario.textproto");
  kill_next(coordinator);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["result"], "done");
}

TEST_F(LostFiles, WithoutTheKeyFileTheKilledComeBackWithTheKey) {
  const fs::path key = folder_ / "c.key";
  ASSERT_EQ(write_key_file(key, key_text(make_mission_key(), true)), std::nullopt);
  Child mission = launch_endless(scenario(), {"--key-file", key});
  // A changed key is meant for the next mission.
  fs::remove(key);
  ASSERT_EQ(write_key_file(key, key_text(make_mission_key(), true)), std::nullopt);
  restart({"ergocast-coordinator"}, "coordinator");
  ASSERT_TRUE(logs("coordinator", "taken over")) << printed();
  fs::remove(key);
  restart(agent(2), "agent-2");
  ASSERT_TRUE(moves_on()) << printed();
  restart({"ergocast-sim"}, "sim");
  ASSERT_TRUE(moves_on()) << printed();
  restart({"ergocast-logger"}, "logger");
  ASSERT_TRUE(moves_on()) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
  EXPECT_EQ(summary()["authenticated"], true);
  EXPECT_EQ(summary()["restarts"], 4) << printed();
}

TEST_F(LostFiles, WithoutTheRunDirectoryTheTeamGoesOnAndTheRunReportsWhatIsMissing) {
  Child mission = launch_endless(scenario(), {"--realtime=5"});
  fs::remove_all(out());
  kill_next({"ergocast-logger"});
  ASSERT_TRUE(eventually([this] { return printed("the team goes on without a record"); }))
      << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 4) << printed();
  EXPECT_TRUE(printed("summary.json: No such file or directory")) << printed();
}

TEST_F(LostFiles, TextInALogControlsNoTerminal) {
  Child mission = launch_endless(scenario());
  std::ofstream(out() / "log" / "agent-1.log") << "\x1b[31m red \xff\n";
  restart(agent(1), "agent-1");
  EXPECT_TRUE(printed("\\x1b[31m red \\xff")) << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 0) << printed();
}

// Another file is in the place of the logger's summary, and the logger writes none.
TEST_F(LostFiles, AForeignSummaryIsNotTakenForTheLoggers) {
  Child mission = launch_endless(scenario(), {"--realtime=5"});
  std::ofstream(out() / "summary.json") << R"({"run_id": 7, "result": 7, "reason": 7})";
  for (int death = 0; death <= 3; ++death) kill_next({"ergocast-logger"});
  ASSERT_TRUE(eventually([this] { return printed("the team goes on without a record"); }))
      << printed();
  mission.send(SIGINT);
  EXPECT_EQ(wait_for(mission), 4) << printed();
  EXPECT_EQ(summary()["reason"],
            "the logger left no summary; logger was killed by SIGKILL after 3 restarts");
}

}  // namespace
}  // namespace ergocast::test
