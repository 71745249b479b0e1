// SPDX-License-Identifier: BSD-3-Clause
// A mission of real processes that a test disturbs.
//
// Machines differ tenfold in speed, both ways, so no test may need a fast or a slow one. A
// disturbed mission either lasts until the test ends it (launch_endless()), or stands still at a
// tick while the test acts (launch_held()). A test waits for visible events and never sleeps
// instead. tests/at_speed checks that: with ERGOCAST_TEST_SPEED=fast, which is read here, missions
// run several times as fast. The default mission then has a tenth of its ticks.
#pragma once

#include <algorithm>
#include <deque>
#include <thread>

#include "core/base/ids.h"
#include "tests/process/support/programs.h"

namespace ergocast::test {

/// Ids of the processes on this host whose command line contains all of `words`.
inline std::vector<pid_t> pids(const std::vector<std::string>& words) {
  std::vector<pid_t> found;
  for (const std::string& process : processes_on_own_host()) {
    const pid_t pid = pid_of(process);
    std::string command = text_of("/proc/" + std::to_string(pid) + "/cmdline");
    std::replace(command.begin(), command.end(), '\0', ' ');
    if (std::all_of(words.begin(), words.end(), [&command](const std::string& word) {
          return command.find(word) != command.npos;
        })) {
      found.push_back(pid);
    }
  }
  return found;
}

inline std::vector<std::string> agent(int id) {
  return {"ergocast-agent", "--id " + std::to_string(id)};
}

/// For tests in either pace, of which "--lockstep" is one.
inline std::string name_of_pace(const ::testing::TestParamInfo<const char*>& pace) {
  return pace.param == std::string("--lockstep") ? "Lockstep" : "Realtime";
}

class RunningMission : public OwnHost {
 protected:
  /// For missions whose buses the test uses itself.
  static constexpr const char* kUrl = "udpm://239.255.76.67:24700?ttl=0";

  /// Mission time [s] that is longer than any test: the limit, 10⁸ ticks.
  static constexpr const char* kEndless = "10000000";
  /// The tick at which a held mission waits.
  static constexpr int kHeldTick = 50;

  /// The default scenario with other or more fields in its `time` and `agents`. By default,
  /// time-outs for answers and for gathering the team are longer than any test.
  std::filesystem::path scenario(std::string time = "", const std::string& agents = "") {
    std::string text = text_of(scenario_file("quadrimodal_corners"));
    std::vector<std::string> others{"dt_s: 0.1", "duration_s: 600", "pace: LOCKSTEP",
                                    "lockstep_timeout_s: 600", "admission_timeout_s: 600"};
    if (const char* speed = std::getenv("ERGOCAST_TEST_SPEED"); speed != nullptr) {
      EXPECT_STREQ(speed, "fast");
      for (const char* axis : {"modes_x: ", "modes_y: "}) text.replace(text.find(axis) + 9, 2, "2");
      others[1] = "duration_s: 60";
      others.push_back("broadcast_period_ticks: 20");
    }
    for (const std::string& field : others) {
      if (time.find(field.substr(0, field.find(':'))) == time.npos) time += ' ' + field;
    }
    const auto begin = text.find("time {");
    text.replace(begin, text.find('}', begin) - begin, "time { " + time + ' ');
    text.replace(text.find("starts {"), 0, agents + "  ");
    const auto file = folder_ / "quadrimodal_corners.textproto";
    std::ofstream(file) << text;
    return file;
  }

  /// Starts `ergocast run` and waits until the mission is well under way.
  Child launch(const std::filesystem::path& scenario, const std::vector<std::string>& more = {}) {
    Child mission = start_mission(scenario, more);
    EXPECT_TRUE(recorded(30000)) << printed();
    return mission;
  }
  /// A mission that does not end by itself, and does not fill a disk.
  Child launch_endless(const std::filesystem::path& scenario, std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--duration", kEndless});
    if (std::find(more.begin(), more.end(), "--event-log-limit") == more.end()) {
      more.insert(more.end(), {"--event-log-limit", "128"});
    }
    return launch(scenario, more);
  }
  /// A mission in lockstep that waits at a tick until release(): agent 0 is stopped just before its
  /// answer to tick kHeldTick.
  Child launch_held(const std::filesystem::path& scenario,
                    const std::vector<std::string>& more = {}) {
    hold_next("ERGOCAST_COMMAND_0", kHeldTick);
    Child mission = start_mission(scenario, more);
    EXPECT_TRUE(eventually([] { return stopped(pids(agent(0))); })) << printed();
    hold_none();
    return mission;
  }
  static void release() { signal_to(agent(0), SIGCONT); }

  /// For programs started from now on: stops the first one before it sends a message on that
  /// channel at that tick or later.
  void hold_next(const std::string& channel, Tick tick) const {
    const auto once = folder_ / "hold";
    std::ofstream(once).close();
    setenv("ERGOCAST_HOLD", (channel + ' ' + std::to_string(tick) + ' ' + once.string()).c_str(),
           1);
    setenv("LD_PRELOAD", ERGOCAST_HOLD_AT, 1);
    // With AddressSanitizer: a preloaded library is fine.
    const char* others = std::getenv("ASAN_OPTIONS");
    const std::string options = others != nullptr ? others : "";
    setenv("ASAN_OPTIONS", (options + ":verify_asan_link_order=0").c_str(), 1);
  }
  static void hold_none() {
    for (const char* name : {"ERGOCAST_HOLD", "LD_PRELOAD"}) unsetenv(name);
  }
  /// Whether there is exactly one such process, and it is stopped.
  static bool stopped(const std::vector<pid_t>& processes) {
    if (processes.size() != 1) return false;
    const std::string stat = text_of("/proc/" + std::to_string(processes[0]) + "/stat");
    return stat.substr(stat.rfind(')') + 1).starts_with(" T");
  }

  /// The output of `ergocast run`, and that of one of its processes.
  std::string printed() const { return text_of(mission_log_); }
  bool printed(const std::string& part) const { return printed().find(part) != std::string::npos; }
  std::string log_of(const std::string& process) const {
    return text_of(out() / "log" / (process + ".log"));
  }
  /// By the summary: whether each command came in time, and no tick was skipped. It is not so in
  /// real time on a slow machine.
  bool all_on_time() const {
    const auto summary = this->summary();
    return summary["missed_deadlines"] == 0 && summary["skipped_ticks"] == 0;
  }
  /// Waits until `process` has logged `part` that many times.
  bool logs(const std::string& process, const std::string& part, int times = 1) const {
    return eventually([&] {
      const std::string log = log_of(process);
      int count = 0;
      for (auto at = log.find(part); at != log.npos; at = log.find(part, at + 1)) ++count;
      return count >= times;
    });
  }
  /// The tick from which an amendment holds, by the output of the last command.
  Tick since_tick() const {
    const std::string text = output(), since = "holds since tick ";
    const auto at = text.find(since);
    EXPECT_NE(at, text.npos) << text;
    return at == text.npos ? 0 : std::stoll(text.substr(at + since.size()));
  }
  /// Waits until the record has grown by `bytes`.
  bool moves_on(std::uintmax_t bytes = 30000) const { return recorded(recorded_bytes() + bytes); }

  static void signal_to(const std::vector<std::string>& words, int signal) {
    const auto targets = pids(words);
    ASSERT_EQ(targets.size(), 1U) << ::testing::PrintToString(words);
    kill(targets.front(), signal);
  }
  /// Kills a process as soon as it exists, and waits until it is gone.
  static void kill_next(const std::vector<std::string>& words) {
    ASSERT_TRUE(eventually([&] { return pids(words).size() == 1; }))
        << ::testing::PrintToString(words);
    const pid_t pid = pids(words).front();
    kill(pid, SIGKILL);
    ASSERT_TRUE(eventually([&] {
      const auto left = pids(words);
      return left.empty() || left.front() != pid;
    }));
  }
  /// Stops a process for 5 s.
  static void freeze(const std::vector<std::string>& words) {
    signal_to(words, SIGSTOP);
    std::this_thread::sleep_for(std::chrono::seconds(5));
    signal_to(words, SIGCONT);
  }

  /// The exit code of `ergocast amend` for the mission on kUrl.
  int amend(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"amend", "--lcm-url", kUrl});
    return ergocast(std::move(arguments));
  }

  Child start_mission(const std::filesystem::path& scenario, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"run", scenario, "--out", out()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Child mission = start("ergocast", arguments);
    mission_log_ = log_;
    return mission;
  }

  std::filesystem::path mission_log_;
};

/// Programs that a test starts one by one, as a person would. They end with the test.
class ByHand : public RunningMission {
 protected:
  struct Program {
    Child child;
    std::filesystem::path log;
    std::string printed() const { return text_of(log); }
    bool prints(const std::string& part) const {
      return eventually([&] { return printed().find(part) != std::string::npos; }, child.pid());
    }
  };

  Program& hand(const std::string& program, std::vector<std::string> arguments = {}) {
    arguments.insert(arguments.end(), {"--lcm-url", url_});
    if (program == "ergocast-logger") {
      arguments.insert(arguments.end(), {"--event-log-limit", "128"});  // fills no disk
    }
    Child child = start(program, arguments);
    return programs_.emplace_back(Program{child, log_});
  }
  /// Logger, world and coordinator; the agents are the test's.
  Program& hand_all_but_agents(const std::filesystem::path& scenario) {
    std::filesystem::create_directory(out());
    hand("ergocast-logger", {"--out", out()});
    hand("ergocast-sim");
    return hand("ergocast-coordinator", {scenario});
  }

  void TearDown() override {
    forget_watched();
    for (Program& program : programs_) {
      // The process may be stopped, so it gets SIGCONT. But not after SIGTERM: SIGCONT would cancel
      // the SIGSTOP with which the leak sanitizer holds an ending process's threads, and the
      // process would never end.
      program.child.send(SIGCONT);
      program.child.send(SIGTERM);
    }
    for (Program& program : programs_) wait_for(program.child);
    OwnHost::TearDown();
  }

  std::string url_ = kUrl;

 private:
  std::deque<Program> programs_;
};

}  // namespace ergocast::test
