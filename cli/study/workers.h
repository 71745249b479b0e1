// SPDX-License-Identifier: BSD-3-Clause
// Runs many jobs in worker processes: a crash, an abort or a hang costs one job.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <type_traits>

#include "runtime/process/signals.h"

namespace ergocast::cli {

/// The maximum size of a result. Each worker has a pipe of its own, so a long result may arrive in
/// pieces.
inline constexpr std::size_t kMostResultBytes = 16000;

/// The functions for the jobs 0 … count − 1.
struct Jobs {
  std::uint64_t count = 0;
  int processes = 1;
  unsigned patience_s = 0;  ///< processor time after which a job counts as hung; 0: never
  std::size_t result_bytes = 0;
  /// Called in a worker; writes `result_bytes` bytes.
  std::function<void(std::uint64_t job, std::byte* result)> work;
  /// Called here with the result of each job, in any order.
  std::function<void(std::uint64_t job, const std::byte* result)> take;
  /// Called here for a job that ended its process, with how the process ended.
  std::function<void(std::uint64_t job, const std::string& how)> lost;
  /// Called here several times a second; false ends the work early.
  std::function<bool()> go_on;
};

/// Does all jobs, or stops at a signal.
void work_in_processes(const Jobs& jobs, StopSignals& signals);

/// Makes Jobs whose results have the type Result.
template <class Result, class Work, class Take>
Jobs jobs_with_results(Work work, Take take) {
  static_assert(std::is_trivially_copyable_v<Result> && sizeof(Result) <= kMostResultBytes);
  Jobs jobs;
  jobs.result_bytes = sizeof(Result);
  jobs.work = [work](std::uint64_t job, std::byte* bytes) {
    const Result result = work(job);
    std::memcpy(bytes, &result, sizeof result);
  };
  jobs.take = [take](std::uint64_t job, const std::byte* bytes) {
    Result result;
    std::memcpy(&result, bytes, sizeof result);
    take(job, result);
  };
  return jobs;
}

}  // namespace ergocast::cli
