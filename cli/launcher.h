// A mission's processes on this host: started, watched, restarted and ended.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/messages.h"
#include "runtime/child.h"
#include "runtime/lcm_url.h"

namespace ergocast::cli {

class ProgressDisplay;

/// How a process's life went, for the summary.
struct ProcessFate {
  std::string name;
  int restarts = 0;
  std::string fate;
};

class Launcher {
 public:
  struct Setup {
    std::filesystem::path programs;    ///< folder of the ergocast-* executables
    std::filesystem::path run_dir;
    LcmUrl url;
    RunId run = 0;
    int agents = 0;
  };

  Launcher(Setup setup, ProgressDisplay& display) : setup_(std::move(setup)), display_(display) {}

  /// Starts logger, world, coordinator and agents. An error if one cannot be started at all.
  std::optional<std::string> start();

  /// Looks after the processes at `now`: names who died and why, restarts agents, and presses those
  /// that do not end when they should.
  void attend(Instant now);

  /// True when every process has ended and none will be started again.
  bool all_ended();

  /// The mission is to end: attend() restarts nobody any more and waits for the processes to go.
  void expect_end(Instant now);
  bool end_expected() const { return end_expected_.has_value(); }

  /// Something that makes the mission a failure; the first one counts.
  const std::optional<std::string>& failure() const { return failure_; }
  /// Whether the logger died with the record unfinished.
  bool record_broken() const { return record_broken_; }

  /// Ends the remaining processes: 1 politely (SIGTERM), 2 at once (SIGKILL).
  void press(int how_hard);

  int restarts() const;
  std::vector<ProcessFate> fates() const;

 private:
  enum class Role { kLogger, kWorld, kCoordinator, kAgent };
  struct Process {
    std::string name;
    Role role;
    Child::Program program;
    std::optional<Child> child;
    bool end_noted = false;
    int restarts = 0;
    std::optional<Instant> restart_at;
  };

  void plan(Role role, std::string name, const std::string& program,
            std::vector<std::string> arguments);
  std::optional<std::string> launch(Process& process);
  void take_note(Process& process, Instant now);
  void explain(const Process& process);
  void restart(Process& process);
  void fail(std::string reason);

  Setup setup_;
  ProgressDisplay& display_;
  std::vector<Process> processes_;
  std::optional<std::string> failure_;
  bool record_broken_ = false;
  std::optional<Instant> end_expected_;
  int pressed_ = 0;
};

}  // namespace ergocast::cli
