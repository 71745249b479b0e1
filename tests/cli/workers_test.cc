// SPDX-License-Identifier: BSD-3-Clause
// Jobs in worker processes: a job that hangs or crashes loses only its own result.
#include "cli/study/workers.h"

#include <gtest/gtest.h>

#include <csignal>
#include <map>
#include <thread>

namespace ergocast::cli {
namespace {

/// Job 1 never ends, job 3 kills its process, job 4 waits for longer than the patience.
int answer(std::uint64_t job) {
  volatile bool forever = job == 1;
  while (forever) {
  }
  if (job == 3) std::raise(SIGKILL);
  if (job == 4) std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  return 10 * static_cast<int>(job);
}

TEST(Workers, LoseAJobThatHangsOrCrashesAndNoOther) {
  std::map<std::uint64_t, int> results;
  std::map<std::uint64_t, std::string> lost;
  Jobs jobs =
      jobs_with_results<int>(answer, [&](std::uint64_t job, int result) { results[job] = result; });
  jobs.count = 6;
  jobs.processes = 2;
  jobs.patience_s = 1;
  jobs.lost = [&](std::uint64_t job, const std::string& how) { lost[job] = how; };
  jobs.go_on = [] { return true; };
  StopSignals signals;
  work_in_processes(jobs, signals);
  EXPECT_EQ(results, (std::map<std::uint64_t, int>{{0, 0}, {2, 20}, {4, 40}, {5, 50}}));
  EXPECT_EQ(lost, (std::map<std::uint64_t, std::string>{{1, "no end after 1 s of processor time"},
                                                        {3, "its process was killed by SIGKILL"}}));
}

}  // namespace
}  // namespace ergocast::cli
