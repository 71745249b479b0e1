// SPDX-License-Identifier: BSD-3-Clause
// Forks a process that is killed when its parent ends or the handle is destroyed.
#include "tests/bench/forked.h"

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <stdexcept>

namespace ergocast::bench {

Forked::Forked(const std::function<void()>& life) {
  const pid_t parent = getpid();
  pid_ = fork();
  if (pid_ < 0) throw std::runtime_error("fork() failed");
  if (pid_ > 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (getppid() == parent) life();  // otherwise the parent ended before the request
  _exit(0);
}

Forked::~Forked() {
  if (pid_ < 0) return;
  kill(pid_, SIGKILL);
  while (waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

}  // namespace ergocast::bench
