#include "cli/launcher.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

#include "cli/progress.h"
#include "runtime/node.h"

namespace ergocast::cli {
namespace {

using namespace std::chrono_literals;

constexpr int kMaxRestarts = 3;
constexpr auto kFirstBackOff = 500ms;
constexpr auto kLongestBackOff = 5s;
/// How long processes may take to end by themselves, and then after SIGTERM.
constexpr auto kPatience = 6s;
constexpr auto kPoliteness = 2s;
constexpr int kLinesOfExplanation = 5;

std::chrono::nanoseconds back_off(int restarts) {
  return std::min<std::chrono::nanoseconds>(kFirstBackOff * (1 << restarts), kLongestBackOff);
}

}  // namespace

void Launcher::plan(Role role, std::string name, const std::string& program,
                    std::vector<std::string> arguments) {
  Process process;
  process.role = role;
  process.program.command = {(setup_.programs / program).string(), "--lcm-url", setup_.url.base(),
                             "--run-id", to_hex(setup_.run)};
  auto& command = process.program.command;
  command.insert(command.end(), arguments.begin(), arguments.end());
  process.program.log = setup_.run_dir / "log" / (name + ".log");
  // The logger still closes its files when we are gone; the others have nothing to lose.
  process.program.signal_if_orphaned = role == Role::kLogger ? SIGTERM : SIGKILL;
  process.name = std::move(name);
  processes_.push_back(std::move(process));
}

std::optional<std::string> Launcher::start() {
  plan(Role::kLogger, "logger", "ergocast-logger", {"--out", setup_.run_dir.string()});
  plan(Role::kWorld, "sim", "ergocast-sim", {});
  plan(Role::kCoordinator, "coordinator", "ergocast-coordinator",
       {(setup_.run_dir / "scenario.textproto").string()});
  for (int id = 0; id < setup_.agents; ++id) {
    plan(Role::kAgent, "agent-" + std::to_string(id), "ergocast-agent",
         {"--id", std::to_string(id)});
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

std::optional<std::string> Launcher::launch(Process& process) {
  auto started = Child::start(process.program);
  if (auto* problem = std::get_if<std::string>(&started)) return std::move(*problem);
  process.child = std::get<Child>(std::move(started));
  process.end_noted = false;
  return std::nullopt;
}

void Launcher::attend(Instant now) {
  for (Process& process : processes_) {
    if (process.child && !process.end_noted && !process.child->running()) take_note(process, now);
    if (process.restart_at && now >= *process.restart_at) {
      process.restart_at.reset();
      if (!end_expected_) restart(process);
    }
  }
  if (!end_expected_) return;
  if (pressed_ < 1 && now - *end_expected_ > kPatience) press(1);
  if (pressed_ < 2 && now - *end_expected_ > kPatience + kPoliteness) press(2);
}

void Launcher::take_note(Process& process, Instant now) {
  process.end_noted = true;
  const auto code = process.child->exit_code();
  if (process.role == Role::kAgent) {
    // An agent that ends in order may simply have seen the mission's end before us.
    if (code != kExitDone && !(end_expected_ && code == kExitFailed)) explain(process);
    process.restart_at = now + back_off(process.restarts);
    return;
  }
  if (process.role == Role::kCoordinator && (code == kExitDone || code == kExitFailed)) {
    // Its last words may have been lost, or we may have been asleep.
    if (code == kExitFailed) fail("the coordinator ended the mission; see log/coordinator.log");
    return expect_end(now);
  }
  if (code == kExitDone) return;
  explain(process);
  if (process.role != Role::kLogger) {
    if (!end_expected_) fail("the " + process.name + " process " + process.child->fate());
    return;
  }
  // A record that cannot be written ends a run that exists for its record; after a crash the team
  // goes on without.
  record_broken_ = true;
  if (code) fail("the record cannot be written; see log/logger.log");
}

void Launcher::restart(Process& process) {
  if (process.child->exit_code() == kExitDone) explain(process);
  if (process.restarts >= kMaxRestarts) {
    return fail(process.name + " " + process.child->fate() + " after " +
                std::to_string(kMaxRestarts) + " restarts");
  }
  ++process.restarts;
  display_.say(process.name + ": restarted (" + std::to_string(process.restarts) + " of " +
               std::to_string(kMaxRestarts) + ")");
  if (const auto problem = launch(process)) fail(*problem);
}

void Launcher::explain(const Process& process) {
  display_.say(process.name + " (process " + std::to_string(process.child->pid()) + ") " +
               process.child->fate() + "; the end of " + process.program.log.string() + ":");
  std::string tail = last_lines(process.program.log, kLinesOfExplanation);
  if (!tail.empty()) tail.pop_back();
  display_.say(tail.empty() ? "    (nothing was logged)" : tail);
}

void Launcher::fail(std::string reason) {
  if (!failure_) failure_ = std::move(reason);
}

bool Launcher::all_ended() {
  return std::all_of(processes_.begin(), processes_.end(), [this](Process& process) {
    return (!process.child || !process.child->running()) &&
           (end_expected_ || !process.restart_at);
  });
}

void Launcher::expect_end(Instant now) {
  if (!end_expected_) end_expected_ = now;
}

void Launcher::press(int how_hard) {
  pressed_ = std::max(pressed_, how_hard);
  for (Process& process : processes_) {
    if (!process.child || !process.child->running()) continue;
    display_.say(process.name + ": " + (how_hard == 1 ? "asked to end" : "killed"));
    process.child->send(how_hard == 1 ? SIGTERM : SIGKILL);
  }
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
