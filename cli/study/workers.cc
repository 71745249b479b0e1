// SPDX-License-Identifier: BSD-3-Clause
// Forks workers. Each does a range of jobs and sends results of fixed size through its own pipe.
#include "cli/study/workers.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <deque>
#include <system_error>
#include <vector>

#include "cli/study/receive_whole.h"

namespace ergocast::cli {
namespace {

/// A worker process is replaced after this many jobs.
constexpr std::uint64_t kMostJobsPerWorker = 64;
constexpr int kIdlePeriod_ms = 100;

/// What a worker writes: the job's number, then its result.
using Parcel = std::array<std::byte, sizeof(std::uint64_t) + kMostResultBytes>;

/// Jobs first … last.
struct JobRange {
  std::uint64_t first, last;
};

struct Worker {
  pid_t pid = 0;
  int pipe = -1;
  JobRange jobs;  // those without a result yet
};

[[noreturn]] void work(const JobRange& range, int pipe, const Jobs& jobs) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  Parcel parcel;
  const std::size_t size = sizeof(std::uint64_t) + jobs.result_bytes;
  for (std::uint64_t job = range.first; job <= range.last; ++job) {
    const itimerval patience{{0, 0}, {static_cast<time_t>(jobs.patience_s), 0}};
    setitimer(ITIMER_PROF, &patience,
              nullptr);  // processor time, because a busy machine is no hang
    std::memcpy(parcel.data(), &job, sizeof job);
    jobs.work(job, parcel.data() + sizeof job);
    if (write(pipe, parcel.data(), size) != static_cast<ssize_t>(size)) _exit(1);
  }
  _exit(0);
}

Worker hire(const JobRange& range, const Jobs& jobs) {
  int ends[2];  // no program that a worker starts gets them
  if (pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe2");
  std::fflush(nullptr);
  const pid_t pid = fork();
  if (pid < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (pid == 0) {
    close(ends[0]);
    work(range, ends[1], jobs);
  }
  close(ends[1]);
  return {pid, ends[0], range};
}

std::string how_it_died(int status, unsigned patience_s) {
  if (!WIFSIGNALED(status))
    return "its process ended with code " + std::to_string(WEXITSTATUS(status));
  if (WTERMSIG(status) == SIGPROF) {
    return "no end after " + std::to_string(patience_s) + " s of processor time";
  }
  return std::string("its process was killed by SIG") + signal_name(WTERMSIG(status));
}

class Pool {
 public:
  explicit Pool(const Jobs& jobs)
      : jobs_(jobs), processes_(static_cast<std::size_t>(jobs.processes)) {
    const std::uint64_t share = std::max<std::uint64_t>(1, jobs.count / (processes_ * 4));
    const std::uint64_t size = std::min(kMostJobsPerWorker, share);
    for (std::uint64_t first = 0; first < jobs.count; first += size) {
      todo_.push_back({first, std::min(first + size, jobs.count) - 1});
    }
  }
  ~Pool() {
    for (const Worker& worker : workers_) {
      kill(worker.pid, SIGKILL);
      waitpid(worker.pid, nullptr, 0);
      close(worker.pipe);
    }
  }
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  bool done() const { return todo_.empty() && workers_.empty(); }

  void fill() {
    while (workers_.size() < processes_ && !todo_.empty()) {
      workers_.push_back(hire(todo_.front(), jobs_));
      todo_.pop_front();
    }
  }

  /// Waits for a result or a signal, at most a short time.
  void wait(int signal_fd) {
    std::vector<pollfd> polled{{signal_fd, POLLIN, 0}};
    for (const Worker& worker : workers_) polled.push_back({worker.pipe, POLLIN, 0});
    if (poll(polled.data(), polled.size(), kIdlePeriod_ms) <= 0) return;
    for (std::size_t i = workers_.size(); i-- > 0;) {
      if (polled[i + 1].revents != 0 && !listen(workers_[i])) {
        workers_.erase(workers_.begin() + static_cast<std::ptrdiff_t>(i));
      }
    }
  }

 private:
  /// Returns false once the worker has ended.
  bool listen(Worker& worker) {
    Parcel parcel;
    const std::size_t size = sizeof(std::uint64_t) + jobs_.result_bytes;
    if (receive_whole(worker.pipe, parcel.data(), size)) {
      std::uint64_t job = 0;
      std::memcpy(&job, parcel.data(), sizeof job);
      worker.jobs.first = job + 1;
      jobs_.take(job, parcel.data() + sizeof job);
      return true;
    }
    int status = 0;
    waitpid(worker.pid, &status, 0);
    close(worker.pipe);
    if (worker.jobs.first > worker.jobs.last) return false;
    jobs_.lost(worker.jobs.first, how_it_died(status, jobs_.patience_s));
    if (++worker.jobs.first <= worker.jobs.last) todo_.push_front(worker.jobs);
    return false;
  }

  const Jobs& jobs_;
  std::size_t processes_;
  std::deque<JobRange> todo_;
  std::vector<Worker> workers_;
};

}  // namespace

void work_in_processes(const Jobs& jobs, StopSignals& signals) {
  Pool pool(jobs);
  while (!pool.done() && signals.take() == 0 && jobs.go_on()) {
    pool.fill();
    pool.wait(signals.fd());
  }
}

}  // namespace ergocast::cli
