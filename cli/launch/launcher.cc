// SPDX-License-Identifier: BSD-3-Clause
// Keeps a state for each process. Each call of attend() decides whether to wait, restart, report or
// kill.
#include "cli/launch/launcher.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

#include "cli/watch/progress.h"
#include "runtime/process/program_options.h"
#include "text/printable.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

/// Limit (Commands): restarts of a process under `ergocast run`. Beyond it: the mission goes on
/// without it, or fails.
constexpr int kMaxRestarts = 3;
/// A program counts as lost if the system cannot execute it for this time.
constexpr auto kLaunchPatience = 30s;
/// How long processes may take to exit by themselves, and then after SIGTERM.
constexpr auto kEndPatience = 6s;
constexpr auto kPoliteness = 2s;
constexpr int kLinesOfExplanation = 5;

}  // namespace

void Launcher::plan(Role role, std::string name, const std::filesystem::path& program,
                    std::vector<std::string> arguments) {
  Process process;
  process.role = role;
  process.program.command = {(setup_.programs / program).string(), "--lcm-url", setup_.url.base(),
                             "--run-id", to_hex(setup_.run)};
  hand_key(process);
  if (role == Role::kLogger || role == Role::kCoordinator) hand(process, "--plan", setup_.plan);
  if (role == Role::kLogger || role == Role::kAgent) hand(process, "--modes", setup_.modes);
  auto& command = process.program.command;
  command.insert(command.end(), arguments.begin(), arguments.end());
  process.program.log = setup_.run_dir / "log" / (name + ".log");
  // The logger can still close its files if the launcher is killed; other processes have none.
  process.program.signal_if_orphaned = role == Role::kLogger ? SIGTERM : SIGKILL;
  process.name = std::move(name);
  processes_.push_back(std::move(process));
}

/// Passes the file to the process with that option, if there is a file.
void Launcher::hand(Process& process, const char* option, const std::optional<SealedFile>& file) {
  if (!file) return;
  const std::string path = process.program.hand(file->descriptor());
  process.program.command.insert(process.program.command.end(), {option, path});
}

/// A program that replaces the world may start another one, which inherits no descriptor of ours.
void Launcher::hand_key(Process& process) const {
  if (process.role != Role::kWorld || is_simulated())
    return hand(process, "--key-file", setup_.key);
  if (setup_.key_file.empty()) return;
  process.program.command.insert(process.program.command.end(),
                                 {"--key-file", setup_.key_file.string()});
}

std::optional<std::string> Launcher::start() {
  plan(Role::kLogger, "logger", "ergocast-logger",
       {"--out", setup_.run_dir.string(), "--event-log-limit",
        std::to_string(setup_.event_log_mib)});
  if (setup_.event_log_zstd) processes_.back().program.command.push_back("--event-log-zstd");
  plan(Role::kWorld, is_simulated() ? "sim" : "world", setup_.world, setup_.world_arguments);
  plan(Role::kCoordinator, "coordinator", "ergocast-coordinator", {});
  for (int id = 0; id < setup_.agents; ++id) {
    plan(Role::kAgent, "agent-" + std::to_string(id), "ergocast-agent",
         {"--id", std::to_string(id)});
    processes_.back().agent = id;
    if (setup_.kinds.empty()) continue;
    for (const std::string& word :
         {std::string("--kind"), setup_.kinds[static_cast<std::size_t>(id)]})
      processes_.back().program.command.push_back(word);
  }
  for (const Process& process : processes_) {
    const std::string& program = process.program.command.front();
    if (access(program.c_str(), X_OK) != 0) return program + ": " + std::strerror(errno);
  }
  for (Process& process : processes_) {
    if (auto problem = launch(process)) return problem;
  }
  return std::nullopt;
}

std::optional<std::string> Launcher::launch(Process& process, bool resume) {
  Child::Program program = process.program;
  if (resume) program.command.push_back("--resume");
  auto started = Child::start(program);
  if (!started) return started.error();
  process.child = *std::move(started);
  process.end_noted = false;
  return std::nullopt;
}

void Launcher::attend(Instant now, Stage stage) {
  if (stage == Stage::kOver) expect_end(now);
  for (Process& process : processes_) {
    if (process.child && !process.end_noted && !process.child->running()) {
      take_note(process, now, stage);
    }
    if (process.restart_at && now >= *process.restart_at) {
      process.restart_at.reset();
      if (!end_expected_) restart(process, now, stage);
    }
  }
  note_forgetting(stage);
  if (!end_expected_) return;
  if (escalated_ < 1 && now - *end_expected_ > kEndPatience) escalate(1);
  if (escalated_ < 2 && now - *end_expected_ > kEndPatience + kPoliteness) escalate(2);
}

/// Only the agents keep the team's coverage. If all agents have stopped at once, the law starts
/// from zero; the record still has the whole mission.
void Launcher::note_forgetting(Stage stage) {
  if (stage != Stage::kRunning || end_expected_ || failure_ || forgot_) return;
  forgot_ = std::none_of(processes_.begin(), processes_.end(), [](Process& process) {
    const bool lives_or_left = !process.end_noted || process.child->exit_code() == kExitDone;
    return process.role == Role::kAgent && lives_or_left;
  });
  if (forgot_)
    display_.print("no agent is left: agents started from now on do not know what was covered");
}

void Launcher::take_note(Process& process, Instant now, Stage stage) {
  process.end_noted = true;
  const auto code = process.child->exit_code();
  if (implies_the_end(process)) expect_end(now);
  if (process.departs) return display_.print(process.name + " was sent out of the mission");
  if (ended_as_expected(process)) return;
  const bool refused = code == kExitUnavailable || !process.child->executed();
  // A process that exits normally may have received the mission's end before us.
  if (code != kExitDone && !(refused && process.refusals > 0)) explain(process);
  if (end_expected_ && process.role == Role::kLogger && code && code != kExitDone) {
    fail("the record cannot be written; see log/logger.log");
  }
  if (end_expected_ || failure_) return;
  if (refused) return try_again(process, now, stage, process.child->executed());
  process.refusals = 0;
  process.without_program_since.reset();
  // The coordinator has yielded to another one, or has found no mission to take over.
  const bool gave_way = process.role == Role::kCoordinator && code == kExitFailed;
  const bool too_often = code != kExitDone && process.restarts >= kMaxRestarts;
  if (gave_way || too_often) return give_up(process, stage);
  // The agent has reached the last tick or left. Without a coordinator no successor can join.
  if (process.role == Role::kAgent && code == kExitDone && leaderless()) return;
  process.restart_at = now + restart_delay(process.restarts);
}

/// The process's last messages may have been lost, or the launcher may have been suspended.
bool Launcher::implies_the_end(const Process& process) {
  return process.child->exit_code() == kExitDone && process.role != Role::kAgent &&
         !runs(Role::kCoordinator);
}

bool Launcher::ended_as_expected(const Process& process) const {
  if (!end_expected_) return false;
  const auto code = process.child->exit_code();
  const bool knows_failure = process.role == Role::kAgent || process.role == Role::kCoordinator;
  return code == kExitDone || (code == kExitFailed && knows_failure);
}

void Launcher::restart(Process& process, Instant now, Stage stage) {
  if (process.refusals == 0) {
    if (process.child->exit_code() == kExitDone) explain(process);
    if (process.restarts >= kMaxRestarts) return give_up(process, stage);
    ++process.restarts;
    display_.print(process.name + ": restarted (" + std::to_string(process.restarts) + " of " +
                   std::to_string(kMaxRestarts) + ")");
  }
  // The new coordinator must also start the mission if no agent knows it yet.
  const bool resume = process.role == Role::kLogger ||
                      (process.role == Role::kCoordinator && stage != Stage::kGathering);
  const auto problem = launch(process, resume);
  if (!problem) return;
  if (process.refusals == 0) display_.print(*problem);
  try_again(process, now, stage, false);
}

/// A refused start does not count as a restart, because the process never ran. Without LCM no team
/// can run on this host, so we retry without limit. A missing program may not come back, so we
/// retry only for kLaunchPatience.
void Launcher::try_again(Process& process, Instant now, Stage stage, bool executed) {
  if (executed) process.without_program_since.reset();
  if (!executed && !process.without_program_since) process.without_program_since = now;
  if (process.without_program_since && now - *process.without_program_since >= kLaunchPatience) {
    return give_up(process, stage);
  }
  if (process.refusals == 0) display_.print(process.name + ": will be started as soon as possible");
  process.restart_at = now + restart_delay(process.restarts + process.refusals++);
}

void Launcher::give_up(Process& process, Stage stage) {
  process.given_up = true;
  const std::string loss = loss_of(process);
  if (process.role == Role::kLogger) {
    display_.print(loss + ": the team goes on without a record");
  } else if (process.role == Role::kCoordinator && stage == Stage::kRunning) {
    display_.print(loss + ": the team goes on to the plan's last tick");
  } else {
    fail(loss);
  }
}

std::string Launcher::loss_of(const Process& process) {
  if (process.without_program_since) return process.name + " could not be started again";
  const std::string loss = process.name + " " + process.child->fate();
  if (process.restarts < kMaxRestarts) return loss;
  return loss + " after " + std::to_string(kMaxRestarts) + " restarts";
}

void Launcher::explain(const Process& process) {
  display_.print(process.name + " (process " + std::to_string(process.child->pid()) + ") " +
                 process.child->fate() + "; the end of " + process.program.log.string() + ":");
  std::string tail = last_lines(process.program.log, kLinesOfExplanation);
  if (!tail.empty()) tail.pop_back();
  display_.print(tail.empty() ? "    (nothing was logged)" : printable(tail));
}

void Launcher::fail(std::string reason) {
  if (!failure_) failure_ = std::move(reason);
}

bool Launcher::all_ended() {
  return std::all_of(processes_.begin(), processes_.end(), [this](Process& process) {
    return (!process.child || !process.child->running()) && (end_expected_ || !process.restart_at);
  });
}

void Launcher::expect_departure(AgentId id) {
  for (Process& process : processes_) {
    if (process.agent != id || process.departs) continue;
    process.departs = true;
    process.restart_at.reset();
  }
}

void Launcher::expect_end(Instant now) {
  if (!end_expected_) end_expected_ = now;
}

void Launcher::escalate(int how_hard) {
  escalated_ = std::max(escalated_, how_hard);
  for (Process& process : processes_) {
    if (!process.child || !process.child->running()) continue;
    display_.print(process.name + ": " + (how_hard == 1 ? "asked to end" : "killed"));
    process.child->send(how_hard == 1 ? SIGTERM : SIGKILL);
  }
}

bool Launcher::runs(Role role) {
  return std::any_of(processes_.begin(), processes_.end(), [role](Process& process) {
    return process.role == role && process.child && process.child->running();
  });
}

bool Launcher::record_broken() const {
  return std::any_of(processes_.begin(), processes_.end(), [](const Process& process) {
    return process.role == Role::kLogger && process.end_noted &&
           process.child->exit_code() != kExitDone;
  });
}

bool Launcher::leaderless() const {
  return std::any_of(processes_.begin(), processes_.end(), [](const Process& process) {
    return process.role == Role::kCoordinator && process.given_up;
  });
}

std::string Launcher::losses() const {
  std::string losses;
  for (const Process& process : processes_) {
    if (process.given_up && failure_ != loss_of(process)) losses += "; " + loss_of(process);
  }
  if (forgot_)
    losses +=
        "; all agents had stopped at once, and the new ones did not know what was covered before";
  return losses;
}

int Launcher::restarts() const {
  int count = 0;
  for (const Process& process : processes_) count += process.restarts;
  return count;
}

std::vector<ProcessFate> Launcher::fates() const {
  std::vector<ProcessFate> fates;
  for (const Process& process : processes_) {
    fates.push_back({process.name, process.restarts,
                     process.child ? process.child->fate() : "was not started"});
  }
  return fates;
}

}  // namespace ergocast::cli
