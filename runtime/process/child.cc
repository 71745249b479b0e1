// SPDX-License-Identifier: BSD-3-Clause
// Forks and executes a program with its output in a log file, and ends it when its parent ends.
#include "runtime/process/child.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <deque>
#include <fstream>

#include "runtime/process/signals.h"

namespace ergocast {
namespace {

/// A shell returns this code in the same case; our programs do not use it.
constexpr int kCannotExecute = 127;

constexpr int kFirst = STDERR_FILENO + 1;  // behind the standard streams

/// Gives the descriptors the numbers from kFirst on and closes all others. This also frees one for
/// the log, even if the parent has none left.
void keep_only(int* descriptors, int count) {
  for (int i = 0; i < count; ++i) {
    // Moves it out of the way, so that it is not overwritten before its turn.
    if (descriptors[i] < kFirst + count) {
      descriptors[i] = fcntl(descriptors[i], F_DUPFD, kFirst + count);
    }
  }
  for (int i = 0; i < count; ++i) {
    if (dup2(descriptors[i], kFirst + i) < 0) _exit(kCannotExecute);
  }
  close_range(static_cast<unsigned>(kFirst + count), ~0U, 0);
}

/// Opens the standard streams: otherwise the program's first sockets would take their numbers.
void take_streams(const char* log, int kept) {
  const int nothing = open("/dev/null", O_RDWR);
  const int output = open(log, O_WRONLY | O_CREAT | O_APPEND, 0644);
  if (nothing < 0) _exit(kCannotExecute);
  dup2(nothing, STDIN_FILENO);
  dup2(output < 0 ? nothing : output, STDOUT_FILENO);
  dup2(output < 0 ? nothing : output, STDERR_FILENO);
  close_range(static_cast<unsigned>(kFirst + kept), ~0U, 0);
}

void write_error(const char* text) {
  if (write(STDERR_FILENO, text, std::strlen(text)) < 0) _exit(kCannotExecute);
}

/// The pointers that exec expects.
std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// A new process's program, made ready before the fork.
struct Start {
  char* const* arguments;
  char* const* environment;
  const char* log;
  int* descriptors;
  int descriptor_count;
  int signal_if_orphaned;
  pid_t parent;
};

/// Runs between fork and exec, so it calls only async-signal-safe functions.
[[noreturn]] void become(const Start& start) {
  setpgid(0, 0);
  keep_only(start.descriptors, start.descriptor_count);
  prctl(PR_SET_PDEATHSIG, start.signal_if_orphaned);
  if (getppid() != start.parent) _exit(kCannotExecute);  // the parent ended before prctl()
  take_streams(start.log, start.descriptor_count);
  StopSignals::restore_in_child();
  char* const* arguments = start.arguments;
  execve(arguments[0], arguments, start.environment);
  const char* reason = strerrordesc_np(errno);
  const char* const complaint[]{arguments[0], ": cannot be executed: ", reason, "\n"};
  for (const char* part : complaint) write_error(part);
  _exit(kCannotExecute);
}

}  // namespace

std::string Child::Program::hand(int descriptor) {
  descriptors.push_back(descriptor);
  return "/proc/self/fd/" + std::to_string(kFirst - 1 + std::ssize(descriptors));
}

Result<Child> Child::start(const Program& program) {
  std::vector<std::string> command = program.command, environment;
  for (char** variable = environ; *variable != nullptr; ++variable) {
    environment.emplace_back(*variable);
  }
  environment.insert(environment.end(), program.environment.begin(), program.environment.end());
  const std::vector<char*> arguments = pointers_to(command), variables = pointers_to(environment);
  std::vector<int> descriptors = program.descriptors;

  const Start start{arguments.data(),
                    variables.data(),
                    program.log.c_str(),
                    descriptors.data(),
                    static_cast<int>(descriptors.size()),
                    program.signal_if_orphaned,
                    getpid()};
  const pid_t pid = fork();
  if (pid == 0) become(start);
  if (pid < 0) return failure(command.front() + ": " + std::strerror(errno));
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

std::chrono::nanoseconds restart_delay(int failures) {
  using namespace std::chrono_literals;
  return failures < 3 ? 500ms * (1 << failures) : 4000ms;
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
