// SPDX-License-Identifier: BSD-3-Clause
// Starts, watches, restarts and ends a mission's processes on this host.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/launch/mission_watch.h"
#include "core/base/ids.h"
#include "runtime/bus/lcm_url.h"
#include "runtime/process/child.h"
#include "runtime/process/sealed_file.h"
#include "runtime/record/event_log.h"

namespace ergocast::cli {

class ProgressDisplay;

/// How a process ended, for the summary.
struct ProcessFate {
  std::string name;
  int restarts = 0;
  std::string fate;
};

class Launcher {
 public:
  struct Setup {
    std::filesystem::path programs;  ///< folder of the ergocast-* executables
    std::filesystem::path world;     ///< the simulated world, or the program in its place
    std::vector<std::string> world_arguments;
    std::filesystem::path run_dir;
    LcmUrl url;
    RunId run = 0;
    std::filesystem::path key_file;  ///< the key file that can sign; empty: no key
    /// Sealed copies that the processes inherit. A restarted process works although the original
    /// file was removed or overwritten.
    std::optional<SealedFile> plan;   ///< compiled; needed
    std::optional<SealedFile> modes;  ///< the mission's table of modes, if it has one
    std::optional<SealedFile> key;    ///< what key_file held, if there is one
    int agents = 0;
    std::vector<std::string> kinds;  ///< the kind of each agent; empty if all agents are alike
    std::int64_t event_log_mib = kEventLogMib;
    bool event_log_zstd = false;
  };

  Launcher(Setup setup, ProgressDisplay& display) : setup_(std::move(setup)), display_(display) {}

  /// Starts logger, world, coordinator and agents. Returns an error if one cannot be started.
  std::optional<std::string> start();

  /// Checks the processes at `now`: reports each process that ended, restarts it while the mission
  /// lasts, and signals processes that do not end in time.
  void attend(Instant now, Stage stage);

  /// True when every process has ended and none will be started again.
  bool all_ended();

  /// Call when the mission ends: attend() restarts no more processes and waits until they exit.
  void expect_end(Instant now);

  /// The operator has sent an agent out of the mission: its process is not started again.
  void expect_departure(AgentId id);

  /// Marks the mission as failed; the first reason counts.
  void fail(std::string reason);
  const std::optional<std::string>& failure() const { return failure_; }
  /// Whether the logger has ended with an error.
  bool record_broken() const;
  /// Whether the coordinator exceeded its restarts, or yielded to another coordinator.
  bool leaderless() const;
  /// Whether a coordinator process runs.
  bool led() { return runs(Role::kCoordinator); }
  /// "; coordinator was killed by SIGSEGV after 3 restarts": the processes that the team lost, and
  /// whether it lost its coverage.
  std::string losses() const;

  /// Ends the remaining processes: by SIGTERM if `how_hard` is 1, by SIGKILL if it is 2.
  void escalate(int how_hard);

  int restarts() const;
  std::vector<ProcessFate> fates() const;

 private:
  enum class Role { kLogger, kWorld, kCoordinator, kAgent };
  struct Process {
    std::string name;
    Role role;
    Child::Program program;
    std::optional<Child> child;
    AgentId agent = kUnassigned;  // kAgent: its number
    bool departs = false;         // it was sent out of the mission
    bool end_noted = false, given_up = false;
    int restarts = 0;  // after the process ran and ended
    std::optional<Instant> restart_at;
    int refusals = 0;  // refused starts in a row: the program or LCM was not available
    std::optional<Instant> without_program_since;
  };

  void plan(Role role, std::string name, const std::filesystem::path& program,
            std::vector<std::string> arguments);
  static void hand(Process& process, const char* option, const std::optional<SealedFile>& file);
  void hand_key(Process& process) const;
  void note_forgetting(Stage stage);
  std::optional<std::string> launch(Process& process, bool resume = false);
  bool is_simulated() const { return setup_.world.filename() == "ergocast-sim"; }
  bool runs(Role role);
  void take_note(Process& process, Instant now, Stage stage);
  bool implies_the_end(const Process& process);
  bool ended_as_expected(const Process& process) const;
  void restart(Process& process, Instant now, Stage stage);
  void try_again(Process& process, Instant now, Stage stage, bool executed);
  void give_up(Process& process, Stage stage);
  void explain(const Process& process);
  static std::string loss_of(const Process& process);

  Setup setup_;
  ProgressDisplay& display_;
  std::vector<Process> processes_;
  std::optional<std::string> failure_;
  std::optional<Instant> end_expected_;
  bool forgot_ = false;  // all agents had stopped at the same time
  int escalated_ = 0;
};

}  // namespace ergocast::cli
