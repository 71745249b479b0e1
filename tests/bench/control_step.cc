// SPDX-License-Identifier: BSD-3-Clause
// Times one agent's control step, its lower bound, and the merging of teammates' contributions.
//
// Every timed step comes directly after the merges of the teammates' messages of that tick, as in a
// lockstep mission. Pausing the benchmark's timer there would take as long as the step itself, so
// each step is timed between two readings of the clock. An iteration is a round of many ticks. Its
// time is their median minus that of an empty interval; other load on the machine affects only few
// of them. Teammates take turns within ten ticks at most, so it is the mean of ten medians, one for
// each tick of the turn.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <vector>

#include "tests/bench/step_floor.h"
#include "tests/bench/step_team.h"

namespace ergocast::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTicksPerRound = 1000;
constexpr int kRounds = 50;
constexpr std::size_t kTurn = 10;

/// Durations of one kind of work over a round.
class Timings {
 public:
  template <class Action>
  void add(const Action& action) {
    const auto start = Clock::now();
    action();
    seconds_[next_++ % kTurn].push_back(
        std::chrono::duration<double>(Clock::now() - start).count());
  }
  double take_median() {
    double sum = 0;
    for (std::vector<double>& seconds : seconds_) {
      const std::size_t middle = seconds.size() / 2;
      std::nth_element(seconds.begin(),
                       std::next(seconds.begin(), static_cast<std::ptrdiff_t>(middle)),
                       seconds.end());
      sum += seconds.at(middle);
      seconds.clear();
    }
    return sum / kTurn;
  }

 private:
  std::array<std::vector<double>, kTurn> seconds_;
  std::size_t next_ = 0;
};
static_assert(kTicksPerRound % kTurn == 0);

StepTeam team_of(const benchmark::State& state, Sight sight) {
  return {static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), sight};
}

void ControlStep(benchmark::State& state, Sight sight) {
  StepTeam team = team_of(state, sight);
  StepFloor floor(team.mission(), static_cast<int>(state.range(1)));
  Timings step, floor_step, nothing;
  double floor_s = 0, step_s = 0, furthest_mps = 0;
  for (auto _ : state) {
    for (int i = 0; i < kTicksPerRound; ++i) {
      team.teammates_step();
      team.merge_news();
      floor.take(team.news());
      Eigen::Vector3d ours, theirs;
      step.add([&] { ours = team.step(); });
      floor_step.add([&] { theirs = floor.step(team.tick(), team.places_m()); });
      nothing.add([] {});
      furthest_mps = std::max(furthest_mps, (ours - theirs).norm());
    }
    const double clock_s = nothing.take_median();
    const double round_s = step.take_median() - clock_s;
    state.SetIterationTime(round_s);
    step_s += round_s;
    floor_s += floor_step.take_median() - clock_s;
  }
  if (furthest_mps > 1e-6) state.SkipWithError("the floor does not compute the same command");
  state.counters["step_ns"] = 1e9 * step_s / kRounds;
  state.counters["floor_ns"] = 1e9 * floor_s / kRounds;
  state.counters["step/floor"] = step_s / floor_s;
}

/// The step with the modes of a free domain, compared with as many cosines.
void FreeDomainStep(benchmark::State& state, Sight sight) {
  const auto modes = static_cast<int>(state.range(0)), agents = static_cast<int>(state.range(1));
  StepTeam cosines(modes, agents, sight), free(modes, agents, sight, true);
  Timings with_cosines, with_table, nothing;
  double cosines_s = 0, table_s = 0;
  for (auto _ : state) {
    for (int i = 0; i < kTicksPerRound; ++i) {
      for (StepTeam* team : {&cosines, &free}) {
        team->teammates_step();
        team->merge_news();
      }
      Eigen::Vector3d v_mps;
      with_cosines.add([&] { v_mps = cosines.step(); });
      with_table.add([&] { v_mps = free.step(); });
      nothing.add([] {});
    }
    const double clock_s = nothing.take_median();
    const double round_s = with_table.take_median() - clock_s;
    state.SetIterationTime(round_s);
    table_s += round_s;
    cosines_s += with_cosines.take_median() - clock_s;
  }
  state.counters["step_ns"] = 1e9 * table_s / kRounds;
  state.counters["cosines_ns"] = 1e9 * cosines_s / kRounds;
  state.counters["step/cosines"] = table_s / cosines_s;
}

/// The sums of all teammates in one array, and what they gained last.
class MergeFloor {
 public:
  void take(const std::vector<Contribution>& news) {
    sums_.resize(news.size() * kBlockSize);
    gains_.resize(sums_.size());
    std::size_t at = 0;
    for (const Contribution& block : news) {
      for (const double sum : block.sums) {
        gains_[at] = sum - sums_[at];
        sums_[at++] = sum;
      }
    }
    benchmark::DoNotOptimize(gains_.data());
    benchmark::ClobberMemory();
  }

 private:
  std::vector<double> sums_, gains_;
};

/// All blocks of all teammates, each one new.
void MergeNews(benchmark::State& state) {
  StepTeam team = team_of(state, Sight::kToldEachTick);
  MergeFloor floor;
  Timings merge, floor_merge, nothing;
  double floor_s = 0, merge_s = 0;
  for (auto _ : state) {
    for (int i = 0; i < kTicksPerRound; ++i) {
      team.teammates_step();
      merge.add([&] { team.merge_news(); });
      floor_merge.add([&] { floor.take(team.news()); });
      nothing.add([] {});
    }
    const double clock_s = nothing.take_median();
    const double round_s = merge.take_median() - clock_s;
    state.SetIterationTime(round_s);
    merge_s += round_s;
    floor_s += floor_merge.take_median() - clock_s;
  }
  state.counters["blocks"] = static_cast<double>(team.news().size());
  state.counters["floor_ns"] = 1e9 * floor_s / kRounds;
  state.counters["merge/floor"] = merge_s / floor_s;
}

constexpr std::array kModesPerAxis = {10, 16, 20, 32};

void each_size(benchmark::internal::Benchmark* benchmark, std::initializer_list<int> team_sizes) {
  benchmark->ArgNames({"modes_per_axis", "agents"})->UseManualTime()->Iterations(kRounds);
  for (const int modes : kModesPerAxis) {
    for (const int agents : team_sizes) benchmark->Args({modes, agents});
  }
}

BENCHMARK_CAPTURE(ControlStep, known, Sight::kKnown)->Apply([](auto* benchmark) {
  each_size(benchmark, {1, 4, 16});
});
BENCHMARK_CAPTURE(ControlStep, told_each_tick, Sight::kToldEachTick)->Apply([](auto* benchmark) {
  each_size(benchmark, {4, 16});
});
BENCHMARK_CAPTURE(ControlStep, told_each_10_ticks, Sight::kToldEach10Ticks)
    ->Apply([](auto* benchmark) {
      each_size(benchmark, {4, 16});
    });
BENCHMARK_CAPTURE(ControlStep, reckoned, Sight::kReckoned)->Apply([](auto* benchmark) {
  each_size(benchmark, {4, 16});
});
void each_free_size(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"modes_per_axis", "agents"})->UseManualTime()->Iterations(kRounds);
  for (const int modes : {10, 16, 20}) {
    for (const int agents : {1, 4, 16}) benchmark->Args({modes, agents});
  }
}
BENCHMARK_CAPTURE(FreeDomainStep, known, Sight::kKnown)->Apply(each_free_size);
BENCHMARK_CAPTURE(FreeDomainStep, reckoned, Sight::kReckoned)->Apply(each_free_size);
BENCHMARK(MergeNews)->Apply([](auto* benchmark) { each_size(benchmark, {4}); });

}  // namespace
}  // namespace ergocast::bench

BENCHMARK_MAIN();
