// Many trials over worker processes: one that crashes, aborts or hangs costs one seed.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>

#include "lab/trial.h"
#include "runtime/signals.h"

namespace ergocast::cli {

enum class Verdict { kFine, kTimedOut, kViolated, kDied };

/// What came of one seed, as it travels from a worker to us.
struct TrialReport {
  lab::TrialFigures figures;
  Verdict verdict = Verdict::kFine;
  char what[600] = "";  ///< what was violated, or how the process died
};
static_assert(std::is_trivially_copyable_v<TrialReport>);

struct Seeds {
  std::uint64_t first = 1, last = 1;
  std::uint64_t count() const { return last - first + 1; }
};

/// Calls `fly` once for each seed, in `jobs` processes, and `take` here with what came of it, in
/// any order. `idle` is called several times a second. Ends early when a signal arrives.
void fly_in_processes(const Seeds& seeds, int jobs, StopSignals& signals,
                      const std::function<TrialReport(std::uint64_t seed)>& fly,
                      const std::function<void(const TrialReport&)>& take,
                      const std::function<void()>& idle);

}  // namespace ergocast::cli
