#include "cli/workers.h"

#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <deque>
#include <system_error>
#include <vector>

namespace ergocast::cli {
namespace {

/// Seeds a process flies before it makes room for a fresh one.
constexpr std::uint64_t kMostSeedsPerWorker = 64;
/// A trial takes some hundredths of a second: one that takes so long hangs.
constexpr unsigned kPatience_s = 120;
constexpr int kIdlePeriod_ms = 100;
// So that a report arrives whole or not at all.
static_assert(sizeof(TrialReport) <= 4096);

struct Worker {
  pid_t pid = 0;
  int pipe = -1;
  Seeds seeds;  // those it has not reported yet
};

using Fly = std::function<TrialReport(std::uint64_t)>;

[[noreturn]] void work(const Seeds& seeds, int pipe, const Fly& fly) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (std::uint64_t seed = seeds.first; seed <= seeds.last; ++seed) {
    alarm(kPatience_s);
    const TrialReport report = fly(seed);
    if (write(pipe, &report, sizeof report) != sizeof report) _exit(1);
  }
  _exit(0);
}

Worker hire(const Seeds& seeds, const Fly& fly) {
  int ends[2];
  if (pipe(ends) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  std::fflush(nullptr);
  const pid_t pid = fork();
  if (pid < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (pid == 0) {
    close(ends[0]);
    work(seeds, ends[1], fly);
  }
  close(ends[1]);
  return {pid, ends[0], seeds};
}

std::string how_it_died(int status) {
  if (!WIFSIGNALED(status)) return "its process ended with code " + std::to_string(WEXITSTATUS(status));
  if (WTERMSIG(status) == SIGALRM) {
    return "no end after " + std::to_string(kPatience_s) + " s of wall time";
  }
  return std::string("its process died of ") + signal_name(WTERMSIG(status));
}

class Pool {
 public:
  Pool(const Seeds& seeds, int jobs) : jobs_(static_cast<std::size_t>(jobs)) {
    const std::uint64_t share = std::max<std::uint64_t>(1, seeds.count() / (jobs_ * 4));
    const std::uint64_t size = std::min(kMostSeedsPerWorker, share);
    for (std::uint64_t first = seeds.first;; first += size) {
      const bool last = seeds.last - first < size;
      todo_.push_back({first, last ? seeds.last : first + size - 1});
      if (last) break;
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

  void fill(const Fly& fly) {
    while (workers_.size() < jobs_ && !todo_.empty()) {
      workers_.push_back(hire(todo_.front(), fly));
      todo_.pop_front();
    }
  }

  /// Waits for a report or a signal, for a moment at most.
  void wait(int signal_fd, const std::function<void(const TrialReport&)>& take) {
    std::vector<pollfd> polled{{signal_fd, POLLIN, 0}};
    for (const Worker& worker : workers_) polled.push_back({worker.pipe, POLLIN, 0});
    if (poll(polled.data(), polled.size(), kIdlePeriod_ms) <= 0) return;
    for (std::size_t i = workers_.size(); i-- > 0;) {
      if (polled[i + 1].revents != 0 && !listen(workers_[i], take)) {
        workers_.erase(workers_.begin() + static_cast<std::ptrdiff_t>(i));
      }
    }
  }

 private:
  /// False once the worker has ended.
  bool listen(Worker& worker, const std::function<void(const TrialReport&)>& take) {
    TrialReport report;
    if (read(worker.pipe, &report, sizeof report) == sizeof report) {
      worker.seeds.first = report.figures.seed + 1;
      take(report);
      return true;
    }
    int status = 0;
    waitpid(worker.pid, &status, 0);
    close(worker.pipe);
    if (worker.seeds.first > worker.seeds.last) return false;
    report = {};
    report.figures.seed = worker.seeds.first;
    report.verdict = Verdict::kDied;
    std::snprintf(report.what, sizeof report.what, "%s", how_it_died(status).c_str());
    take(report);
    if (++worker.seeds.first <= worker.seeds.last) todo_.push_front(worker.seeds);
    return false;
  }

  std::size_t jobs_;
  std::deque<Seeds> todo_;
  std::vector<Worker> workers_;
};

}  // namespace

void fly_in_processes(const Seeds& seeds, int jobs, StopSignals& signals, const Fly& fly,
                      const std::function<void(const TrialReport&)>& take,
                      const std::function<void()>& idle) {
  Pool pool(seeds, jobs);
  while (!pool.done() && signals.take() == 0) {
    pool.fill(fly);
    pool.wait(signals.fd(), take);
    idle();
  }
}

}  // namespace ergocast::cli
