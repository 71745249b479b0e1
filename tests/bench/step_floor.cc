// SPDX-License-Identifier: BSD-3-Clause
// Computes tables, sums and command in one pass over padded arrays, with AVX2 intrinsics and
// without.
#include "tests/bench/step_floor.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/noise.h"
#include "core/basis/basis.h"

namespace ergocast::bench {
namespace {

using Ahead = StepFloor::Ahead;
using Mate = StepFloor::Mate;
using Tables = StepFloor::Tables;
using Totals = StepFloor::Totals;
using Waves = StepFloor::Waves;

constexpr int kLanes = 4;

// ---- any processor ----

void waves_anywhere(double x_m, double wave_number, int modes, Waves& out) {
  const double first_cos = std::cos(wave_number * x_m), first_sin = std::sin(wave_number * x_m);
  double c = 1, s = 0;
  for (int m = 0; m < modes; ++m) {
    const double k = m * wave_number;
    out.value[m] = c;
    out.slope[m] = -k * s;
    out.bend[m] = -k * k * c;
    const double next = c * first_cos - s * first_sin;
    s = s * first_cos + c * first_sin;
    c = next;
  }
}

/// A teammate's sums, and its share of the coverage forecast.
template <Ahead kAhead>
double foreseen_anywhere(const Tables& tables, int mate, int m, int n) {
  const int at = (mate * tables.modes + m) * tables.stride + n;
  const Mate& one = tables.mates[mate];
  if (kAhead == Ahead::kNothing) return tables.sums[at];
  if (kAhead == Ahead::kGains) return tables.sums[at] + one.share * tables.gains[at];
  const double wave = one.along_x.value[m] * one.along_y.value[n];
  return (tables.sums[at] += one.step_s * wave) + one.share * wave;
}

template <Ahead kAhead>
Totals pass_anywhere(const Tables& tables, const Waves& along_x, const Waves& along_y, double dt_s,
                     double per_second) {
  Waves::Table over_value{}, over_slope{}, over_bend{}, power{};
  for (int m = 0; m < tables.modes; ++m) {
    const int row = m * tables.stride;
    for (int n = 0; n < tables.stride; ++n) {
      double* own = tables.sums + row + n;
      double team = *own += along_x.value[m] * dt_s * along_y.value[n];
      for (int mate = 1; mate < tables.agents; ++mate)
        team += foreseen_anywhere<kAhead>(tables, mate, m, n);
      const double residual = tables.weight[row + n] * (team * per_second - tables.target[row + n]);
      power[n] += residual * residual * tables.energy[row + n];
      over_value[n] += along_x.value[m] * residual;
      over_slope[n] += along_x.slope[m] * residual;
      over_bend[n] += along_x.bend[m] * residual;
    }
  }
  Totals totals;
  for (int n = 0; n < tables.stride; ++n) {
    totals.power += power[n];
    totals.x += over_slope[n] * along_y.value[n];
    totals.y += over_value[n] * along_y.slope[n];
    totals.xx += over_bend[n] * along_y.value[n];
    totals.xy += over_slope[n] * along_y.slope[n];
    totals.yy += over_value[n] * along_y.bend[n];
  }
  return totals;
}

// ---- AVX2 and FMA ----

#if defined(__x86_64__)
#define ERGOCAST_AVX2 __attribute__((target("avx2,fma")))

/// Four modes at a time, each turned by four times the angle.
ERGOCAST_AVX2 void waves_avx2(double x_m, double wave_number, int modes, Waves& out) {
  const double c1 = std::cos(wave_number * x_m), s1 = std::sin(wave_number * x_m);
  const double c2 = c1 * c1 - s1 * s1, s2 = 2 * s1 * c1;
  const double c3 = c2 * c1 - s2 * s1, s3 = s2 * c1 + c2 * s1;
  const __m256d turn_c = _mm256_set1_pd(c2 * c2 - s2 * s2), turn_s = _mm256_set1_pd(2 * s2 * c2);
  const __m256d sign = _mm256_set1_pd(-0.0), four = _mm256_set1_pd(kLanes * wave_number);
  __m256d c = _mm256_setr_pd(1, c1, c2, c3), s = _mm256_setr_pd(0, s1, s2, s3);
  __m256d k = _mm256_mul_pd(_mm256_setr_pd(0, 1, 2, 3), _mm256_set1_pd(wave_number));
  for (int m = 0; m < modes; m += kLanes) {
    const __m256d minus_k = _mm256_xor_pd(k, sign);
    _mm256_store_pd(&out.value[m], c);
    _mm256_store_pd(&out.slope[m], _mm256_mul_pd(minus_k, s));
    _mm256_store_pd(&out.bend[m], _mm256_mul_pd(_mm256_mul_pd(minus_k, k), c));
    const __m256d next = _mm256_fmsub_pd(c, turn_c, _mm256_mul_pd(s, turn_s));
    s = _mm256_fmadd_pd(s, turn_c, _mm256_mul_pd(c, turn_s));
    c = next;
    k = _mm256_add_pd(k, four);
  }
}

struct Lanes {
  __m256d power, x, y, xx, xy, yy;
};

/// `team` and a teammate's sums, and its share of the forecast, at four modes of row `m`.
template <Ahead kAhead>
ERGOCAST_AVX2 inline __m256d add_mate(__m256d team, const Tables& tables, int mate, int m,
                                      int column) {
  const int at = (mate * tables.modes + m) * tables.stride + column;
  __m256d sums = _mm256_loadu_pd(tables.sums + at);
  if (kAhead == Ahead::kNothing) return _mm256_add_pd(team, sums);
  const Mate& one = tables.mates[mate];
  const __m256d share = _mm256_set1_pd(one.share);
  if (kAhead == Ahead::kGains) {
    return _mm256_fmadd_pd(share, _mm256_loadu_pd(tables.gains + at), _mm256_add_pd(team, sums));
  }
  const __m256d wave = _mm256_mul_pd(_mm256_broadcast_sd(&one.along_x.value[m]),
                                     _mm256_load_pd(&one.along_y.value[column]));
  sums = _mm256_fmadd_pd(_mm256_set1_pd(one.step_s), wave, sums);
  _mm256_storeu_pd(tables.sums + at, sums);
  return _mm256_fmadd_pd(share, wave, _mm256_add_pd(team, sums));
}

/// Processes several vectors of columns at once over all rows, so that the sums stay in registers.
template <Ahead kAhead, int kVectors>
ERGOCAST_AVX2 inline void add_columns(const Tables& tables, const Waves& along_x,
                                      const Waves& along_y, double dt_s, double per_second,
                                      int first, Lanes& lanes) {
  const __m256d scale = _mm256_set1_pd(per_second), dt = _mm256_set1_pd(dt_s);
  __m256d over_value[kVectors], over_slope[kVectors], over_bend[kVectors], sample[kVectors];
  for (int v = 0; v < kVectors; ++v) {
    over_value[v] = over_slope[v] = over_bend[v] = _mm256_setzero_pd();
    sample[v] = _mm256_mul_pd(dt, _mm256_load_pd(&along_y.value[first + v * kLanes]));
  }
  for (int m = 0; m < tables.modes; ++m) {
    const __m256d value = _mm256_broadcast_sd(&along_x.value[m]);
    const __m256d slope = _mm256_broadcast_sd(&along_x.slope[m]);
    const __m256d bend = _mm256_broadcast_sd(&along_x.bend[m]);
    for (int v = 0; v < kVectors; ++v) {
      const int at = m * tables.stride + first + v * kLanes;
      double* own = tables.sums + at;
      __m256d team = _mm256_fmadd_pd(value, sample[v], _mm256_loadu_pd(own));
      _mm256_storeu_pd(own, team);
      for (int mate = 1; mate < tables.agents; ++mate) {
        team = add_mate<kAhead>(team, tables, mate, m, first + v * kLanes);
      }
      const __m256d residual =
          _mm256_mul_pd(_mm256_loadu_pd(tables.weight + at),
                        _mm256_fmsub_pd(team, scale, _mm256_loadu_pd(tables.target + at)));
      lanes.power = _mm256_fmadd_pd(_mm256_mul_pd(residual, residual),
                                    _mm256_loadu_pd(tables.energy + at), lanes.power);
      over_value[v] = _mm256_fmadd_pd(value, residual, over_value[v]);
      over_slope[v] = _mm256_fmadd_pd(slope, residual, over_slope[v]);
      over_bend[v] = _mm256_fmadd_pd(bend, residual, over_bend[v]);
    }
  }
  for (int v = 0; v < kVectors; ++v) {
    const __m256d value = _mm256_load_pd(&along_y.value[first + v * kLanes]);
    const __m256d slope = _mm256_load_pd(&along_y.slope[first + v * kLanes]);
    const __m256d bend = _mm256_load_pd(&along_y.bend[first + v * kLanes]);
    lanes.x = _mm256_fmadd_pd(over_slope[v], value, lanes.x);
    lanes.y = _mm256_fmadd_pd(over_value[v], slope, lanes.y);
    lanes.xx = _mm256_fmadd_pd(over_bend[v], value, lanes.xx);
    lanes.xy = _mm256_fmadd_pd(over_slope[v], slope, lanes.xy);
    lanes.yy = _mm256_fmadd_pd(over_value[v], bend, lanes.yy);
  }
}

ERGOCAST_AVX2 double sum_of(__m256d lanes) {
  const __m128d pair = _mm_add_pd(_mm256_castpd256_pd128(lanes), _mm256_extractf128_pd(lanes, 1));
  return _mm_cvtsd_f64(_mm_add_sd(pair, _mm_unpackhi_pd(pair, pair)));
}

template <Ahead kAhead>
ERGOCAST_AVX2 Totals pass_avx2(const Tables& tables, const Waves& along_x, const Waves& along_y,
                               double dt_s, double per_second) {
  const __m256d zero = _mm256_setzero_pd();
  Lanes lanes{zero, zero, zero, zero, zero, zero};
  int first = 0;
  for (; first + 2 * kLanes <= tables.stride; first += 2 * kLanes) {
    add_columns<kAhead, 2>(tables, along_x, along_y, dt_s, per_second, first, lanes);
  }
  if (first < tables.stride)
    add_columns<kAhead, 1>(tables, along_x, along_y, dt_s, per_second, first, lanes);
  return {sum_of(lanes.power), sum_of(lanes.x),  sum_of(lanes.y),
          sum_of(lanes.xx),    sum_of(lanes.xy), sum_of(lanes.yy)};
}

const bool kHasAvx2 = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
#else
constexpr bool kHasAvx2 = false;
constexpr auto waves_avx2 = waves_anywhere;
template <Ahead kAhead>
constexpr auto pass_avx2 = pass_anywhere<kAhead>;
#endif

const auto waves = kHasAvx2 ? waves_avx2 : waves_anywhere;

template <Ahead kAhead>
const auto pass = kHasAvx2 ? pass_avx2<kAhead> : pass_anywhere<kAhead>;

Ahead ahead_of(const Mission& mission, int agents) {
  if (mission.law.anticipation == 0 || agents == 1) return Ahead::kNothing;
  return mission.dead_reckoning ? Ahead::kPlaces : Ahead::kGains;
}

}  // namespace

StepFloor::StepFloor(const Mission& mission, int agents)
    : mission_(mission),
      look_ahead_(mission),
      ahead_(ahead_of(mission, agents)),
      agents_(agents),
      modes_(mission.basis.modes_x),
      stride_((modes_ + kLanes - 1) / kLanes * kLanes),
      sums_(static_cast<std::size_t>(agents * modes_ * stride_)),
      gains_(sums_),
      mates_(static_cast<std::size_t>(agents)),
      scale_(mission.law, mission.timing.dt_s),
      push_ticks_(push_ticks(mission.law, mission.timing.dt_s)) {
  const auto padded = [this](const Coefficients& table) {
    std::vector<double> all(static_cast<std::size_t>(modes_ * stride_));
    for (int m = 0; m < modes_; ++m)
      std::copy_n(table.data() + m * modes_, modes_, all.data() + m * stride_);
    return all;
  };
  target_ = padded(mission.target_coefficients);
  weight_ = padded(sobolev_weights(mission.basis, mission.domain));
  energy_ = padded(gradient_energies(mission.basis, mission.domain));
}

void StepFloor::take(const std::vector<Contribution>& news) {
  for (const Contribution& block : news) {
    Mate& mate = mates_[static_cast<std::size_t>(block.header.sender)];
    if (block.block == 0) {
      mate.gained_steps = block.steps - mate.steps;
      mate.steps = block.steps;
      mate.tick = block.header.tick;
      mate.period = block.next_broadcast_tick - block.header.tick;
    }
    const int table = block.header.sender * modes_ * stride_;
    const int first = block.block * kBlockSize, end = std::min(first + kBlockSize, modes_ * modes_);
    for (int k = first; k < end; ++k) {
      const auto at = static_cast<std::size_t>(table + k / modes_ * stride_ + k % modes_);
      const double sum = block.sums[static_cast<std::size_t>(k - first)];
      gains_[at] = sum - sums_[at];
      sums_[at] = sum;
    }
  }
}

/// The teammates' positions in this tick.
void StepFloor::see(Tick tick, const std::vector<Eigen::Vector3d>& places_m) {
  const Eigen::Vector2d wave_numbers =
      std::numbers::pi * mission_.domain.size_m.head<2>().cwiseInverse();
  for (std::size_t i = 1; i < mates_.size(); ++i) {
    Mate& mate = mates_[i];
    waves(places_m[i].x(), wave_numbers.x(), stride_, mate.along_x);
    waves(places_m[i].y(), wave_numbers.y(), stride_, mate.along_y);
    const bool is_new = tick > mate.tick;
    mate.step_s = is_new ? mission_.timing.dt_s : 0;
    mate.steps += is_new;
    mate.gained_steps = 1;
    mate.tick = tick;
  }
}

/// The denominator of ĉ, and teammates' shares.
double StepFloor::per_second(Tick tick) {
  const double dt_s = mission_.timing.dt_s, horizon_s = look_ahead_.horizon_s(agents_, tick);
  ++mates_[0].steps;
  double covered_s = 0;
  for (Mate& mate : mates_) {
    covered_s += static_cast<double>(mate.steps) * dt_s;
    if (&mate == &mates_[0] || ahead_ == Ahead::kNothing) continue;
    const double weight_s =
        look_ahead_.weight_s(horizon_s, mate.gained_steps, tick - mate.tick, mate.period);
    covered_s += weight_s;
    mate.share = ahead_ == Ahead::kPlaces
                     ? weight_s
                     : weight_s / (static_cast<double>(mate.gained_steps) * dt_s);
  }
  return 1 / covered_s;
}

/// The pass over the modes at agent 0's place.
Totals StepFloor::totals(const Eigen::Vector3d& x_m, double per_second) {
  const Eigen::Vector2d wave_numbers =
      std::numbers::pi * mission_.domain.size_m.head<2>().cwiseInverse();
  const Tables tables{agents_,        modes_,         stride_,        sums_.data(), gains_.data(),
                      target_.data(), weight_.data(), energy_.data(), mates_.data()};
  // Includes the padding after the last mode, where the weights are zero.
  Waves along_x, along_y;
  waves(x_m.x(), wave_numbers.x(), stride_, along_x);
  waves(x_m.y(), wave_numbers.y(), stride_, along_y);
  const auto over = ahead_ == Ahead::kNothing ? pass<Ahead::kNothing>
                    : ahead_ == Ahead::kGains ? pass<Ahead::kGains>
                                              : pass<Ahead::kPlaces>;
  return over(tables, along_x, along_y, mission_.timing.dt_s, per_second);
}

Eigen::Vector3d StepFloor::step(Tick tick, const std::vector<Eigen::Vector3d>& places_m) {
  if (ahead_ == Ahead::kPlaces) see(tick, places_m);
  const Eigen::Vector3d& x_m = places_m.front();
  const Totals totals = this->totals(x_m, per_second(tick));

  const ControlLaw& law = mission_.law;
  FieldAt field;
  field.gradient.head<2>() << totals.x, totals.y;
  field.hessian.topLeftCorner<2, 2>() << totals.xx, totals.xy, totals.xy, totals.yy;
  const double epsilon = law.epsilon * std::sqrt(totals.power);
  const double length = std::sqrt(field.gradient.squaredNorm() + epsilon * epsilon);
  const Eigen::Vector3d xi = normal_in(mission_.domain, mission_.seed, Purpose::kPerturbation, 0,
                                       static_cast<std::uint64_t>(tick));
  if (const Tick push = tick / push_ticks_; push != push_) {  // constant in between
    push_ = push;
    eta_ = normal_in(mission_.domain, mission_.seed, Purpose::kPush, 0,
                     static_cast<std::uint64_t>(push));
  }
  return -law.u_max_mps / length * field.gradient -
         law.contraction_gain_per_s * (x_m - law.contraction_center_m) +
         perturbation(scale_, epsilon, field, xi, eta_);
}

}  // namespace ergocast::bench
