// A mission of real processes that a test disturbs.
#pragma once

#include <algorithm>
#include <deque>

#include "tests/process/programs.h"

namespace ergocast::test {

/// Process ids on this host whose command line contains all of `words`.
inline std::vector<pid_t> pids(const std::vector<std::string>& words) {
  std::vector<pid_t> found;
  for (const std::string& process : processes_on_own_host()) {
    const std::string pid = process.substr(process.find("pid ") + 4);
    std::string command = text_of("/proc/" + pid.substr(0, pid.size() - 1) + "/cmdline");
    std::replace(command.begin(), command.end(), '\0', ' ');
    if (std::all_of(words.begin(), words.end(), [&command](const std::string& word) {
          return command.find(word) != command.npos;
        })) {
      found.push_back(std::stoi(pid));
    }
  }
  return found;
}

inline std::vector<std::string> agent(int id) {
  return {"ergocast-agent", "--id " + std::to_string(id)};
}

class FlyingMission : public OwnHost {
 protected:
  /// For missions whose buses the test uses itself.
  static constexpr const char* kUrl = "udpm://239.255.76.67:24700?ttl=0";

  /// The default scenario with more fields in its `time` and `agents`. A tick may stay unanswered
  /// for longer than any test takes, unless the time-out itself is what is tested.
  std::filesystem::path scenario(std::string time = "", const std::string& agents = "") {
    if (time.find("lockstep_timeout_s") == time.npos) time += " lockstep_timeout_s: 600";
    std::string text = text_of(scenario_file("quadrimodal_corners"));
    text.replace(text.find("pace:"), 0, time + "  ");
    text.replace(text.find("starts {"), 0, agents + "  ");
    const auto file = folder_ / "quadrimodal_corners.textproto";
    std::ofstream(file) << text;
    return file;
  }

  /// Starts `ergocast run` and waits until the mission is well under way.
  Child launch(const std::filesystem::path& scenario, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"run", scenario, "--out", out()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Child mission = start("ergocast", arguments);
    mission_log_ = log_;
    EXPECT_TRUE(recorded(30000)) << said();
    return mission;
  }
  /// One that does not end by itself.
  Child launch_endless(const std::filesystem::path& scenario, std::vector<std::string> more = {}) {
    more.insert(more.end(), {"--duration", "100000"});
    return launch(scenario, more);
  }

  /// What `ergocast run` has said, and what one of its processes.
  std::string said() const { return text_of(mission_log_); }
  bool said(const std::string& part) const { return said().find(part) != std::string::npos; }
  std::string log_of(const std::string& process) const {
    return text_of(out() / "log" / (process + ".log"));
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
  /// Waits until the record has grown by `bytes`.
  bool moves_on(std::uintmax_t bytes = 30000) const {
    return recorded(recorded_bytes() + bytes);
  }

  static void signal_to(const std::vector<std::string>& words, int signal) {
    const auto targets = pids(words);
    ASSERT_EQ(targets.size(), 1U) << ::testing::PrintToString(words);
    kill(targets.front(), signal);
  }
  /// Kills a process as soon as there is one, and waits until it is gone.
  static void kill_next(const std::vector<std::string>& words) {
    ASSERT_TRUE(eventually([&] { return pids(words).size() == 1; })) << ::testing::PrintToString(words);
    const pid_t pid = pids(words).front();
    kill(pid, SIGKILL);
    ASSERT_TRUE(eventually([&] { const auto left = pids(words);
                                 return left.empty() || left.front() != pid; }));
  }
  /// Stops a process for 5 s.
  static void freeze(const std::vector<std::string>& words) {
    signal_to(words, SIGSTOP);
    std::this_thread::sleep_for(std::chrono::seconds(5));
    signal_to(words, SIGCONT);
  }

  std::filesystem::path mission_log_;
};

/// Programs that a test starts one by one, as a person would; they end with the test.
class ByHand : public FlyingMission {
 protected:
  struct Program {
    Child child;
    std::filesystem::path log;
    std::string said() const { return text_of(log); }
    bool says(const std::string& part) const {
      return eventually([&] { return said().find(part) != std::string::npos; });
    }
  };

  Program& hand(const std::string& program, std::vector<std::string> arguments = {}) {
    arguments.insert(arguments.end(), {"--lcm-url", url_});
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
    for (Program& program : programs_) {
      program.child.send(SIGTERM);
      program.child.send(SIGCONT);  // it may have been stopped
    }
    for (Program& program : programs_) wait_for(program.child);
    OwnHost::TearDown();
  }

  std::string url_ = kUrl;

 private:
  std::deque<Program> programs_;
};

}  // namespace ergocast::test
