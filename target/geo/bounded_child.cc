// SPDX-License-Identifier: BSD-3-Clause
// The child writes its answer into a pipe, and ends.
#include "target/geo/bounded_child.h"

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <fstream>

namespace ergocast {
namespace {

void bound(int resource, rlim_t most) {
  const rlimit limit{most, most};
  setrlimit(static_cast<__rlimit_resource>(resource), &limit);
}

/// Sanitizers need more memory than there is.
void bound_memory() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  std::ifstream pages("/proc/self/statm");
  std::size_t now = 0;
  pages >> now;
  bound(RLIMIT_AS, now * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)) + kMostChildBytes);
#endif
}

/// False if the reader is gone.
bool write_all(int out, const std::string& answer) {
  for (std::size_t done = 0; done < answer.size();) {
    const ssize_t wrote = ::write(out, answer.data() + done, answer.size() - done);
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote <= 0) return false;
    done += static_cast<std::size_t>(wrote);
  }
  return true;
}

[[noreturn]] void become_child(int out, const std::function<std::string()>& work) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int signal : {SIGABRT, SIGSEGV, SIGXCPU, SIGALRM, SIGINT, SIGTERM, SIGTRAP, SIGPIPE})
    std::signal(signal, SIG_DFL);
  for (std::FILE* const stream : {stdout, stderr})
    if (std::freopen("/dev/null", "w", stream) == nullptr) _exit(1);
  bound(RLIMIT_CORE, 0);
  bound(RLIMIT_CPU, kMostChildSeconds);
  alarm(10 * kMostChildSeconds);
  bound_memory();
  try {
    _exit(write_all(out, work()) ? 0 : 1);
  } catch (...) {  // else the child would go on as a second copy of this program
    _exit(1);
  }
}

/// All that comes until the other end is closed; nothing if it is more than `most_bytes`.
std::optional<std::string> read_all(int in, std::size_t most_bytes) {
  std::string answer;
  std::array<char, 1 << 16> block{};
  for (;;) {
    const ssize_t got = ::read(in, block.data(), block.size());
    if (got < 0 && errno == EINTR) continue;
    if (got < 0 || answer.size() + static_cast<std::size_t>(got) > most_bytes) return std::nullopt;
    if (got == 0) return answer;
    answer.append(block.data(), static_cast<std::size_t>(got));
  }
}

}  // namespace

std::optional<std::string> in_bounded_child(std::size_t most_bytes,
                                            const std::function<std::string()>& work) {
  std::array<int, 2> pipe_ends{};
  if (pipe(pipe_ends.data()) != 0) return std::nullopt;
  const auto [in, out] = pipe_ends;
  const pid_t child = fork();
  if (child == 0) {
    close(in);
    become_child(out, work);
  }
  close(out);
  std::optional<std::string> answer;
  if (child > 0) answer = read_all(in, most_bytes);
  close(in);
  int status = 0;
  while (child > 0 && waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) return std::nullopt;
  return answer;
}

}  // namespace ergocast
