// SPDX-License-Identifier: BSD-3-Clause
// A run is found without its URL: list, status, watch, spy and stop take the only live one.
#include "tests/process/support/free_rooms.h"
#include "tests/process/support/programs.h"

namespace ergocast::test {
namespace {

namespace fs = std::filesystem;

class Found : public OwnHost {
 protected:
  ~Found() override { fs::remove_all(registry()); }
  static fs::path registry() { return fs::path(std::getenv("XDG_RUNTIME_DIR")) / "ergocast"; }
  static std::vector<fs::path> entries() {
    std::vector<fs::path> files;
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(registry(), none)) {
      if (entry.path().filename().string().front() != '.') files.push_back(entry.path());
    }
    return files;
  }
  bool printed(const std::string& part) const { return output().find(part) != std::string::npos; }

  /// Starts a mission that runs until it is stopped, and waits for its entry and first rows.
  Child start_mission(const std::string& name, const std::vector<std::string>& more = {}) {
    const auto known = entries().size();
    std::vector<std::string> words{"run",         scenario_file("quadrimodal_corners"),
                                   "--realtime",  "--duration",
                                   "100000",      "--out",
                                   folder_ / name};
    words.insert(words.end(), more.begin(), more.end());
    Child child = start("ergocast", words);
    const auto table = folder_ / name / "trajectory.csv";
    std::error_code none;
    EXPECT_TRUE(eventually([&] {
      return entries().size() > known && fs::exists(table, none) && fs::file_size(table, none) > 0;
    })) << output();
    return child;
  }
  /// The runs of `list --json`.
  nlohmann::json listed() {
    EXPECT_EQ(ergocast({"list", "--json"}), 0);
    const std::string text = output();
    return nlohmann::json::parse(text.substr(text.find('[')));
  }
  /// The id of the run with this folder. Runs that started within one second are listed in any
  /// order.
  std::string id_of(const std::string& name) {
    for (const auto& run : listed()) {
      if (run["run_dir"] == (folder_ / name).string()) return run["run_id"];
    }
    ADD_FAILURE() << "no run in " << name;
    return "";
  }
};

TEST_F(Found, TheOnlyLiveRunNeedsNoUrl) {
  EXPECT_EQ(ergocast({"list"}), 0);
  EXPECT_TRUE(printed("no run of this user is live on this host")) << output();
  Child run = start_mission("one");
  const auto runs = listed();
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0]["run_dir"], (folder_ / "one").string());
  const std::string id = runs[0]["run_id"];
  EXPECT_EQ(ergocast({"list"}), 0);
  EXPECT_TRUE(printed(id + "  quadrimodal_corners, since ")) << output();
  ergocast({"status"});
  EXPECT_TRUE(printed("quadrimodal_corners, run " + id + ", running")) << output();
  EXPECT_EQ(ergocast({"stop"}), 0) << output();
  EXPECT_TRUE(printed("run " + id + ": asking the coordinator")) << output();
  EXPECT_EQ(wait_for(run), 0);
  EXPECT_TRUE(entries().empty());
}

TEST_F(Found, ItsKeyIsTakenWithIt) {
  const auto key = folder_ / "mission";
  ASSERT_EQ(ergocast({"keygen", key}), 0) << output();
  Child run = start_mission("one", {"--key-file", key.string() + ".coordinator.key"});
  ergocast({"status"});
  EXPECT_TRUE(printed(", running")) << output();
  EXPECT_EQ(ergocast({"stop", "--now"}), 0) << output();
  wait_for(run);
}

TEST_F(Found, OfTwoOneMustBeChosen) {
  Child first = start_mission("one"), second = start_mission("two");
  for (const char* command : {"status", "stop", "watch"}) {
    EXPECT_EQ(ergocast({command}), 2);
    EXPECT_TRUE(
        printed("several runs of this user are live; choose one with --run-id:\n  --run-id "))
        << output();
  }
  EXPECT_TRUE(first.running() && second.running());
  for (const auto& one : listed()) {
    EXPECT_EQ(ergocast({"stop", "--run-id", one["run_id"]}), 0) << output();
  }
  EXPECT_EQ(wait_for(first), 0);
  EXPECT_EQ(wait_for(second), 0);
}

TEST_F(Found, AnEmergencyStopsAllLiveRunsOfThisUser) {
  Child first = start_mission("one"), second = start_mission("two");
  EXPECT_EQ(ergocast({"stop", "--now"}), 0) << output();
  EXPECT_EQ(wait_for(first), 0);
  EXPECT_EQ(wait_for(second), 0);
  for (const char* name : {"one", "two"}) {
    const auto summary = nlohmann::json::parse(text_of(folder_ / name / "summary.json"));
    EXPECT_EQ(summary["emergency_stop"], true) << name;
    const std::string id = summary["run_id"];
    EXPECT_TRUE(printed("run " + id + ": stopped at tick ")) << output();
  }
}

TEST_F(Found, AnEmergencyStopsOnlyTheRunThatIsNamed) {
  Child first = start_mission("one"), second = start_mission("two");
  const std::string named = id_of("one"), other = id_of("two");
  EXPECT_EQ(ergocast({"stop", "--now", "--run-id", named}), 0) << output();
  EXPECT_FALSE(printed(other)) << output();
  EXPECT_EQ(wait_for(first), 0);
  ASSERT_EQ(listed().size(), 1U);
  EXPECT_TRUE(second.running());
  EXPECT_EQ(ergocast({"stop", "--now"}), 0) << output();
  EXPECT_TRUE(printed(other)) << output();
  EXPECT_EQ(wait_for(second), 0);
}

TEST_F(Found, AnEmergencyOfARunThatCannotBeTakenStopsTheOthers) {
  Child first = start_mission("one"), second = start_mission("two");
  const std::string id = id_of("one");
  const auto file = registry() / (id + ".json");
  std::string text = text_of(file);
  const auto at = text.find("\"version\": \"") + 12;
  text.replace(at, text.find('"', at) - at, "9.9.9");
  std::ofstream(file) << text;  // the same file: its lock stays
  EXPECT_EQ(ergocast({"stop", "--now"}), 2);
  EXPECT_TRUE(printed("was started with ergocast 9.9.9, this is ")) << output();
  EXPECT_EQ(wait_for(second), 0);
  EXPECT_TRUE(first.running());
  first.send(SIGINT);
  EXPECT_EQ(wait_for(first), 0);
}

TEST_F(Found, ItsProcessesAreNamedWithTheirIds) {
  Child run = start_mission("one");
  EXPECT_EQ(ergocast({"list"}), 0);
  EXPECT_TRUE(printed("processes: run " + std::to_string(run.pid()) + ", logger ")) << output();
  ASSERT_EQ(ergocast({"list", "--pid", "agent-2"}), 0) << output();
  const std::string pid = output();
  EXPECT_NE(text_of("/proc/" + pid.substr(0, pid.find('\n')) + "/cmdline").find("ergocast-agent"),
            std::string::npos)
      << pid;
  EXPECT_EQ(std::to_string(listed()[0]["processes"]["agent-2"].get<int>()) + '\n', pid);
  EXPECT_EQ(ergocast({"list", "--pid", "agent-9"}), 2);
  EXPECT_TRUE(printed("has no process agent-9 now; it has logger, sim, coordinator, agent-0"))
      << output();
  EXPECT_EQ(kill(std::stoi(pid), SIGKILL), 0);
  ASSERT_TRUE(eventually([&] {
    return ergocast({"list", "--pid", "agent-2"}) == 0 && output() != pid;
  })) << "it is started again, with another id";
  run.send(SIGINT);
  EXPECT_EQ(wait_for(run), 0);
}

TEST_F(Found, HelpNamesWhereACommandLooks) {
  for (const char* command : {"status", "watch", "stop", "pause", "resume"}) {
    EXPECT_EQ(ergocast({command, "--help"}), 0);
    EXPECT_TRUE(printed("default: that of your live run on this host")) << command << output();
    EXPECT_FALSE(printed("URL=udpm")) << command << output();
  }
}

TEST_F(Found, ARunThatWasKilledIsReportedAndNotTaken) {
  Child run = start_mission("one");
  run.send(SIGKILL);
  wait_for(run);
  ASSERT_EQ(entries().size(), 1U);
  EXPECT_EQ(ergocast({"list"}), 0);
  EXPECT_TRUE(printed("warning: run ") && printed("was killed") &&
              printed("no run of this user is live"))
      << output();
  EXPECT_TRUE(entries().empty());
}

// Modes of a free domain take seconds; meanwhile the run is stopped, so that it cannot finish them.
TEST_F(Found, ARunThatStillComputesItsModesIsListedAndCanBeEnded) {
  Child run = start("ergocast", {"run", free_rooms(folder_), "--set", "basis.modes_x=20", "--set",
                                 "basis.modes_y=20", "--out", folder_ / "one"});
  ASSERT_TRUE(eventually([] { return entries().size() == 1; }, run.pid()));
  run.send(SIGSTOP);
  EXPECT_EQ(ergocast({"list"}), 0);
  EXPECT_TRUE(printed("  rooms, since ") && printed("still reads its scenario")) << output();
  const auto runs = listed();
  ASSERT_EQ(runs.size(), 1U);
  EXPECT_EQ(runs[0]["preparing"], true);
  EXPECT_EQ(runs[0]["pid"], run.pid());
  EXPECT_EQ(ergocast({"status"}), 4);
  EXPECT_TRUE(printed("still reads its scenario")) << output();
  Child stop = start("ergocast", {"stop", "--now"});
  EXPECT_TRUE(eventually([&] { return printed("ending it"); }, stop.pid())) << output();
  EXPECT_TRUE(run.running());
  run.send(SIGCONT);
  EXPECT_EQ(wait_for(stop), 0) << output();
  wait_for(run);
  EXPECT_EQ(run.fate(), "was killed by SIGTERM");
  EXPECT_EQ(ergocast({"list"}), 0);
  EXPECT_EQ(output(), "no run of this user is live on this host\n");
  EXPECT_TRUE(entries().empty());
}

TEST_F(Found, ARunOfAnotherVersionIsNotTaken) {
  Child run = start_mission("one");
  const auto file = entries().front();
  std::string text = text_of(file);
  const auto at = text.find("\"version\": \"") + 12;
  text.replace(at, text.find('"', at) - at, "9.9.9");
  std::ofstream(file) << text;  // the same file: its lock stays
  EXPECT_EQ(ergocast({"stop"}), 2);
  EXPECT_TRUE(printed("was started with ergocast 9.9.9, this is ")) << output();
  EXPECT_TRUE(run.running());
  run.send(SIGINT);
  EXPECT_EQ(wait_for(run), 0);
}

TEST_F(Found, AGivenUrlIsNotLookedUp) {
  Child run = start_mission("one");
  const std::string url = listed()[0]["lcm_url"];
  EXPECT_EQ(ergocast({"status", "--lcm-url", "udpm://239.255.76.67:23000?ttl=0"}), 4);
  setenv("LCM_DEFAULT_URL", "udpm://239.255.76.67:23000?ttl=0", 1);
  EXPECT_EQ(ergocast({"stop"}), 4);
  setenv("LCM_DEFAULT_URL", url.c_str(), 1);
  EXPECT_EQ(ergocast({"stop"}), 0) << output();
  unsetenv("LCM_DEFAULT_URL");
  EXPECT_EQ(wait_for(run), 0);
}

TEST_F(Found, AMissionRunsWhereNothingCanBeRegistered) {
  fs::create_directory(registry());
  fs::permissions(registry(), fs::perms::all);
  EXPECT_EQ(ergocast({"run", scenario_file("quadrimodal_corners"), "--duration", "5", "--out",
                      folder_ / "one"}),
            0);
  EXPECT_TRUE(printed("warning: " + registry().string() + ": other users own it, read it or write"))
      << output();
  EXPECT_TRUE(fs::is_empty(registry()));
}

}  // namespace
}  // namespace ergocast::test
