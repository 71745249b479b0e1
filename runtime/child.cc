// SPDX-License-Identifier: BSD-3-Clause
// Forks and executes a program with its output in a log file, and ends it when its parent ends.
#include "runtime/child.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <deque>
#include <fstream>
#include <span>

#include "runtime/signals.h"

namespace ergocast {
namespace {

/// The code that a shell returns, too; our programs do not use it.
constexpr int kCannotExecute = 127;

/// Closes all descriptors but the standard streams and `kept`, which ascend.
void close_all_but(std::span<const int> kept) {
  unsigned first = STDERR_FILENO + 1;
  for (const int descriptor : kept) {
    const auto next = static_cast<unsigned>(descriptor);
    if (next > first) close_range(first, next - 1, 0);
    first = next + 1;
  }
  close_range(first, ~0U, 0);
}

/// Opens the standard streams: otherwise the program's first sockets would take their numbers.
void take_streams(const char* log, std::span<const int> kept) {
  const int nothing = open("/dev/null", O_RDWR);
  const int output = open(log, O_WRONLY | O_CREAT | O_APPEND, 0644);
  if (nothing < 0) _exit(kCannotExecute);
  dup2(nothing, STDIN_FILENO);
  dup2(output < 0 ? nothing : output, STDOUT_FILENO);
  dup2(output < 0 ? nothing : output, STDERR_FILENO);
  close_all_but(kept);
}

void say(const char* text) {
  if (write(STDERR_FILENO, text, std::strlen(text)) < 0) _exit(kCannotExecute);
}

/// Runs between fork and exec, so it calls only async-signal-safe functions.
[[noreturn]] void become(char* const* arguments, const char* log, int signal_if_orphaned,
                         std::span<const int> kept, pid_t parent) {
  setpgid(0, 0);
  // The child inherits nothing else. This also frees a descriptor for the log, even if the parent
  // has none left.
  close_all_but(kept);
  for (const int descriptor : kept) fcntl(descriptor, F_SETFD, 0);
  prctl(PR_SET_PDEATHSIG, signal_if_orphaned);
  if (getppid() != parent) _exit(kCannotExecute);  // the parent ended before prctl()
  take_streams(log, kept);
  StopSignals::restore_in_child();
  execv(arguments[0], arguments);
  const char* reason = strerrordesc_np(errno);
  const char* const complaint[]{arguments[0], ": cannot be executed: ", reason, "\n"};
  for (const char* part : complaint) say(part);
  _exit(kCannotExecute);
}

}  // namespace

std::variant<Child, std::string> Child::start(const Program& program) {
  std::vector<std::string> command = program.command;
  std::vector<char*> arguments;
  for (std::string& word : command) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::vector<int> kept = program.files;
  std::ranges::sort(kept);

  const pid_t parent = getpid();
  const pid_t pid = fork();
  if (pid == 0)
    become(arguments.data(), program.log.c_str(), program.signal_if_orphaned, kept, parent);
  if (pid < 0) return command.front() + ": " + std::strerror(errno);
  return Child(pid);
}

bool Child::running() {
  if (status_) return false;
  int status = 0;
  const pid_t ended = waitpid(pid_, &status, WNOHANG);
  if (ended == 0 || (ended < 0 && errno == EINTR)) return true;
  status_ = ended == pid_ ? status : W_EXITCODE(kCannotExecute, 0);  // reaped elsewhere
  return false;
}

void Child::send(int signal) {
  if (running()) kill(pid_, signal);
}

std::optional<int> Child::exit_code() const {
  if (!status_ || !WIFEXITED(*status_)) return std::nullopt;
  return WEXITSTATUS(*status_);
}

bool Child::executed() const { return exit_code() != kCannotExecute; }

std::string Child::fate() const {
  if (!status_) return "is running";
  if (!executed()) return "could not be executed";
  if (WIFEXITED(*status_)) return "exited with code " + std::to_string(WEXITSTATUS(*status_));
  return std::string("was killed by SIG") + signal_name(WTERMSIG(*status_));
}

std::string last_lines(const std::filesystem::path& file, int count) {
  std::ifstream in(file);
  std::deque<std::string> tail;
  for (std::string line; std::getline(in, line);) {
    tail.push_back(std::move(line));
    if (tail.size() > static_cast<std::size_t>(count)) tail.pop_front();
  }
  std::string text;
  for (const std::string& line : tail) text += "    " + line + '\n';
  return text;
}

}  // namespace ergocast
