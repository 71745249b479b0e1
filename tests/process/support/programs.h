// SPDX-License-Identifier: BSD-3-Clause
// Runs the real programs from a test.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "runtime/process/child.h"
#include "tests/process/support/logs.h"
#include "tests/process/support/waiting.h"
#include "tests/support/own_host.h"
#include "tests/support/temp_folder.h"

namespace ergocast::test {

/// Empty if it cannot be read. (An iterator would throw where a process ends while its file in
/// /proc is read.)
inline std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

inline std::filesystem::path scenario_file(const std::string& name) {
  return std::filesystem::path(ERGOCAST_SCENARIO_DIR) / (name + ".textproto");
}

/// The folder of our programs: that of this build, unless the environment names another.
inline std::filesystem::path program_folder() {
  const char* others = std::getenv("ERGOCAST_BIN_DIR");
  return others != nullptr ? others : ERGOCAST_BIN_DIR;
}

/// The id in a text of processes_on_own_host().
inline pid_t pid_of(const std::string& process) {
  return std::stoi(process.substr(process.find("pid ") + 4));
}

/// A folder that is removed after the test, and the programs' network.
class OwnHost : public ::testing::Test {
 protected:
  /// A failed test may leave its mission running. Prints the output of its processes, the only
  /// information on them, and ends them.
  void TearDown() override {
    forget_watched();
    if (HasFailure()) {
      tell_logs();
      eventually([] { return kill_all(), processes_on_own_host().empty(); });
      return;
    }
    EXPECT_TRUE(eventually([] { return processes_on_own_host().empty(); }))
        << "left behind: " << ::testing::PrintToString(processes_on_own_host());
    if (HasFailure()) tell_logs();
  }

  /// Starts one of our programs; its output goes to `log_`.
  Child start(const std::string& program, std::vector<std::string> arguments) {
    log_ = folder_ / ("output-" + std::to_string(++started_));
    note_command(program, arguments);
    arguments.insert(arguments.begin(), (program_folder() / program).string());
    return start_watched({arguments, log_, SIGKILL});
  }
  /// Starts a program of the system; its output goes to `log_`.
  Child begin(const std::vector<std::string>& command) {
    log_ = folder_ / ("tool-" + std::to_string(++begun_));
    return start_watched({command, log_, SIGKILL});
  }
  /// The program's exit code, or −signal.
  static int wait_for(Child& child) {
    if (!eventually([&child] { return !child.running(); })) {
      child.send(SIGKILL);
      ADD_FAILURE() << "did not end";
    }
    return child.exit_code().value_or(-1);
  }
  /// Runs a program to its end; returns the exit code. The output is in output().
  int run(const std::string& program, std::vector<std::string> arguments) {
    Child child = start(program, std::move(arguments));
    return wait_for(child);
  }
  int ergocast(std::vector<std::string> arguments) { return run("ergocast", std::move(arguments)); }
  std::string output() const { return text_of(log_); }
  bool answered(const std::string& part) const { return output().find(part) != std::string::npos; }

  std::filesystem::path out() const { return folder_ / "run"; }
  nlohmann::json summary() const { return nlohmann::json::parse(text_of(out() / "summary.json")); }

  /// Size of the recorded trajectory, all segments.
  std::uintmax_t recorded_bytes() const {
    std::uintmax_t bytes = 0;
    std::error_code none;
    for (const auto& file : std::filesystem::directory_iterator(out(), none)) {
      if (file.path().filename().string().starts_with("trajectory")) bytes += file.file_size();
    }
    return bytes;
  }
  /// Waits until that many bytes are on disk, so that the mission is under way.
  bool recorded(std::uintmax_t bytes) const {
    return eventually([&] { return recorded_bytes() >= bytes; });
  }

  const TempFolder own_;
  const std::filesystem::path& folder_ = own_.path();
  std::filesystem::path log_;

 private:
  /// If a test repeats a question, only the last answer is kept.
  void note_command(const std::string& program, const std::vector<std::string>& arguments) {
    std::string command = program;
    for (const std::string& argument : arguments) command += ' ' + argument;
    if (program == "ergocast") {
      std::erase_if(commands_, [&](const auto& one) { return one.second == command; });
    }
    commands_[log_.filename()] = command;
  }
  void tell_logs() const {
    std::printf("%s", ends_of_logs(folder_, commands_).c_str());
    std::fflush(stdout);
  }
  static void kill_all() {
    for (const std::string& process : processes_on_own_host()) kill(pid_of(process), SIGKILL);
  }

  int started_ = 0, begun_ = 0;
  std::map<std::string, std::string> commands_;  // by the name of the log
};

}  // namespace ergocast::test
