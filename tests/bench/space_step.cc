// SPDX-License-Identifier: BSD-3-Clause
// Times one agent's control step in a box, alone and with known coverage. For comparison it times a
// kernel written by hand: raw arrays, one pass over the modes, AVX2 and fused multiply-add. Each is
// timed between two readings of the clock, in turns. An iteration is a round of many ticks; its
// time is the median.
#include <benchmark/benchmark.h>
#include <immintrin.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <vector>

#include "core/base/noise.h"
#include "core/law/control.h"
#include "core/law/coverage_table.h"
#include "core/law/perturbation.h"

namespace ergocast::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kTicksPerRound = 1000, kRounds = 50;
constexpr int kLanes = 4, kMostModes = 16;

Mission mission_of(int modes) {
  Mission mission;
  mission.domain = {{0, 0, 0}, {1000, 1000, 1000}};
  mission.basis = {.modes_x = modes, .modes_y = modes, .modes_z = modes, .sobolev_exponent = 2};
  mission.target_coefficients = Coefficients::Zero(mission.basis.mode_count());
  for (Eigen::Index k = 0; k < mission.target_coefficients.size(); ++k)
    mission.target_coefficients[k] =
        std::cos(static_cast<double>(k)) / (1 + static_cast<double>(k));
  ControlLaw& law = mission.law;
  law.u_max_mps = 20;
  law.regularization = Regularization::kRelative;
  law.epsilon = 0.2;
  law.perturbation = Perturbation::kAdaptive;
  law.noise_intensity = 0.7;
  law.noise_ceiling = 14;
  mission.timing.tick_count = 1'000'000;
  return mission;
}

/// One axis: cos(k·x) for every mode with its first two derivatives, padded with zeros.
struct Waves {
  alignas(32) double value[kMostModes] = {}, slope[kMostModes] = {}, bend[kMostModes] = {};

  Waves(double x_m, double wave_number, int modes) {
    const double first_cos = std::cos(wave_number * x_m), first_sin = std::sin(wave_number * x_m);
    double c = 1, s = 0;
    for (int m = 0; m < modes; ++m) {
      const double k = m * wave_number;
      value[m] = c;
      slope[m] = -k * s;
      bend[m] = -k * k * c;
      const double next = c * first_cos - s * first_sin;
      s = s * first_cos + c * first_sin;
      c = next;
    }
  }
};

class Floor {
 public:
  explicit Floor(const Mission& mission)
      : mission_(mission),
        modes_(mission.basis.modes_x),
        stride_((modes_ + kLanes - 1) / kLanes * kLanes),
        scale_(mission.law, mission.timing.dt_s),
        push_ticks_(push_ticks(mission.law, mission.timing.dt_s)) {
    const auto padded = [this](const Coefficients& table) {
      std::vector<double> all(static_cast<std::size_t>(modes_ * modes_ * stride_));
      for (int row = 0; row < modes_ * modes_; ++row)
        std::copy_n(table.data() + row * modes_, modes_, all.data() + row * stride_);
      return all;
    };
    target_ = padded(mission.target_coefficients);
    weight_ = padded(sobolev_weights(mission.basis, mission.domain));
    energy_ = padded(gradient_energies(mission.basis, mission.domain));
    sums_.resize(target_.size());
  }

  Eigen::Vector3d step(Tick tick, const Eigen::Vector3d& x_m) {
    const double dt_s = mission_.timing.dt_s;
    FieldAt field;
    const double power = pass(x_m, 1 / (static_cast<double>(tick + 1) * dt_s), field);
    const ControlLaw& law = mission_.law;
    const double epsilon = law.epsilon * std::sqrt(power);
    const double length = std::sqrt(field.gradient.squaredNorm() + epsilon * epsilon);
    const auto step = static_cast<std::uint64_t>(tick);
    const Eigen::Vector3d xi =
        normal_in(mission_.domain, mission_.seed, Purpose::kPerturbation, 0, step);
    if (const Tick push = tick / push_ticks_; push != push_) {
      push_ = push;
      eta_ = normal_in(mission_.domain, mission_.seed, Purpose::kPush, 0,
                       static_cast<std::uint64_t>(push));
    }
    return -law.u_max_mps / length * field.gradient +
           perturbation(scale_, epsilon, field, xi, eta_);
  }

 private:
  __attribute__((target("avx2,fma"))) double pass(const Eigen::Vector3d& x_m, double per_second,
                                                  FieldAt& field) {
    const Eigen::Vector3d wave = std::numbers::pi * mission_.domain.size_m.cwiseInverse();
    const Waves x(x_m.x(), wave.x(), modes_), y(x_m.y(), wave.y(), modes_),
        z(x_m.z(), wave.z(), modes_);
    const __m256d rate = _mm256_set1_pd(per_second);
    __m256d power = _mm256_setzero_pd(), sum[10];
    for (__m256d& one : sum) one = power;
    for (int column = 0; column < stride_; column += kLanes) {
      const __m256d y0 = _mm256_load_pd(y.value + column), y1 = _mm256_load_pd(y.slope + column),
                    y2 = _mm256_load_pd(y.bend + column);
      // z and x: value value, value slope, value bend, slope value, slope slope, bend value.
      __m256d over[6];
      for (__m256d& one : over) one = _mm256_setzero_pd();
      for (int l = 0; l < modes_; ++l) {
        const __m256d here = _mm256_mul_pd(_mm256_set1_pd(z.value[l] * mission_.timing.dt_s), y0);
        __m256d value = _mm256_setzero_pd(), slope = value, bend = value;
        for (int m = 0; m < modes_; ++m) {
          const int at = (l * modes_ + m) * stride_ + column;
          const __m256d cosine = _mm256_set1_pd(x.value[m]);
          const __m256d own = _mm256_fmadd_pd(cosine, here, _mm256_loadu_pd(sums_.data() + at));
          _mm256_storeu_pd(sums_.data() + at, own);
          const __m256d residual =
              _mm256_mul_pd(_mm256_loadu_pd(weight_.data() + at),
                            _mm256_fmsub_pd(own, rate, _mm256_loadu_pd(target_.data() + at)));
          power = _mm256_fmadd_pd(_mm256_mul_pd(residual, residual),
                                  _mm256_loadu_pd(energy_.data() + at), power);
          value = _mm256_fmadd_pd(cosine, residual, value);
          slope = _mm256_fmadd_pd(_mm256_set1_pd(x.slope[m]), residual, slope);
          bend = _mm256_fmadd_pd(_mm256_set1_pd(x.bend[m]), residual, bend);
        }
        const __m256d z0 = _mm256_set1_pd(z.value[l]), z1 = _mm256_set1_pd(z.slope[l]);
        over[0] = _mm256_fmadd_pd(z0, value, over[0]);
        over[1] = _mm256_fmadd_pd(z0, slope, over[1]);
        over[2] = _mm256_fmadd_pd(z0, bend, over[2]);
        over[3] = _mm256_fmadd_pd(z1, value, over[3]);
        over[4] = _mm256_fmadd_pd(z1, slope, over[4]);
        over[5] = _mm256_fmadd_pd(_mm256_set1_pd(z.bend[l]), value, over[5]);
      }
      const __m256d parts[9][2] = {{over[1], y0}, {over[0], y1}, {over[3], y0},
                                   {over[2], y0}, {over[1], y1}, {over[4], y0},
                                   {over[0], y2}, {over[3], y1}, {over[5], y0}};
      for (int i = 0; i < 9; ++i) sum[i] = _mm256_fmadd_pd(parts[i][0], parts[i][1], sum[i]);
    }
    const auto total = [](const __m256d& lanes) {
      return (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]);
    };
    field.gradient << total(sum[0]), total(sum[1]), total(sum[2]);
    field.hessian << total(sum[3]), total(sum[4]), total(sum[5]), total(sum[4]), total(sum[6]),
        total(sum[7]), total(sum[5]), total(sum[7]), total(sum[8]);
    return total(power);
  }

  Mission mission_;
  int modes_, stride_;
  std::vector<double> sums_, target_, weight_, energy_;
  PerturbationScale scale_;
  Tick push_ticks_, push_ = -1;
  Eigen::Vector3d eta_{0, 0, 0};
};

double median(std::vector<double>& seconds) {
  const auto middle = seconds.begin() + std::ssize(seconds) / 2;
  std::nth_element(seconds.begin(), middle, seconds.end());
  const double found = *middle;
  seconds.clear();
  return found;
}

void SpaceStep(benchmark::State& state) {
  if (!__builtin_cpu_supports("avx2") || !__builtin_cpu_supports("fma"))
    return state.SkipWithError("the kernel by hand needs AVX2 and FMA");
  const Mission mission = mission_of(static_cast<int>(state.range(0)));
  CoverageTable table(mission.basis, mission.timing.dt_s);
  Controller controller(mission);
  Coefficients coverage = Coefficients::Zero(mission.basis.mode_count());
  Floor floor(mission);
  Eigen::Vector3d x_m(310, 420, 530);
  std::vector<double> ours_s, theirs_s, nothing_s;
  const auto timed = [](std::vector<double>& seconds, const auto& action) {
    const auto start = Clock::now();
    action();
    seconds.push_back(std::chrono::duration<double>(Clock::now() - start).count());
  };
  Tick tick = 0;
  double step_s = 0, floor_s = 0, furthest_mps = 0;
  for (auto _ : state) {
    for (int i = 0; i < kTicksPerRound; ++i, ++tick) {
      Eigen::Vector3d ours, theirs;
      timed(ours_s, [&] {
        const BasisAt at(x_m, mission.domain, mission.basis);
        table.add_sample({0, 1}, at);
        table.average(coverage);
        controller.set_coverage(coverage);
        ours = controller.command(0, tick, x_m, at);
      });
      timed(theirs_s, [&] { theirs = floor.step(tick, x_m); });
      timed(nothing_s, [] {});
      furthest_mps = std::max(furthest_mps, (ours - theirs).norm());
      x_m = reflect(x_m + mission.timing.dt_s * ours, mission.domain);
    }
    const double clock_s = median(nothing_s), round_s = median(ours_s) - clock_s;
    state.SetIterationTime(round_s);
    step_s += round_s;
    floor_s += median(theirs_s) - clock_s;
  }
  if (furthest_mps > 1e-6) state.SkipWithError("the floor does not compute the same command");
  state.counters["floor_ns"] = 1e9 * floor_s / kRounds;
  state.counters["step/floor"] = step_s / floor_s;
}

BENCHMARK(SpaceStep)
    ->ArgName("modes_per_axis")
    ->UseManualTime()
    ->Iterations(kRounds)
    ->Arg(10)
    ->Arg(15);

}  // namespace
}  // namespace ergocast::bench

BENCHMARK_MAIN();
