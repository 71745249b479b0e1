#include "bench/step_floor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "core/basis.h"
#include "core/noise.h"
#include "core/perturbation.h"

namespace ergocast::bench {
namespace {

using Table = std::array<double, kMaxModesPerAxis>;

void waves_at(double x_m, double length_m, int modes, Table& value, Table& slope) {
  const double wave_number = std::numbers::pi / length_m;
  const double first_cos = std::cos(wave_number * x_m), first_sin = std::sin(wave_number * x_m);
  double c = 1, s = 0;
  for (int m = 0; m < modes; ++m) {
    value[m] = c;
    slope[m] = -m * wave_number * s;
    const double next = c * first_cos - s * first_sin;
    s = s * first_cos + c * first_sin;
    c = next;
  }
}

std::vector<double> flat(const Coefficients& table) {
  return {table.data(), table.data() + table.size()};
}

}  // namespace

StepFloor::StepFloor(const Mission& mission, int agents)
    : mission_(mission),
      agents_(agents),
      modes_(mission.basis.modes_x),
      sums_(static_cast<std::size_t>(agents * mission.basis.mode_count())),
      target_(flat(mission.target_coefficients)),
      weight_(flat(sobolev_weights(mission.basis, mission.domain))),
      energy_(flat(gradient_energies(mission.basis, mission.domain))) {}

void StepFloor::take(const std::vector<Contribution>& news) {
  const int count = mission_.basis.mode_count();
  for (const Contribution& block : news) {
    const int first = block.block * kBlockSize;
    std::copy_n(block.sums.data(), std::min(kBlockSize, count - first),
                sums_.data() + block.header.sender * count + first);
  }
}

Eigen::Vector2d StepFloor::step(Tick tick, const Eigen::Vector2d& x_m) {
  const double dt_s = mission_.timing.dt_s;
  const int count = modes_ * modes_;
  Table cos_x, slope_x, cos_y, slope_y, over_bend{}, over_slope{}, over_cos{}, power{};
  waves_at(x_m.x(), mission_.domain.size_m.x(), modes_, cos_x, slope_x);
  waves_at(x_m.y(), mission_.domain.size_m.y(), modes_, cos_y, slope_y);
  const double wave_x2 = std::pow(std::numbers::pi / mission_.domain.size_m.x(), 2);
  const double wave_y2 = std::pow(std::numbers::pi / mission_.domain.size_m.y(), 2);
  const double per_second = 1 / (static_cast<double>(++steps_ * agents_) * dt_s);

  // Short loops over n without branches, each of which the compiler turns into vector instructions.
  Table team;
  for (int m = 0; m < modes_; ++m) {
    double* own = sums_.data() + m * modes_;
    const double along_x = cos_x[m] * dt_s;
    for (int n = 0; n < modes_; ++n) team[n] = own[n] += along_x * cos_y[n];
    for (int mate = 1; mate < agents_; ++mate) {
      const double* theirs = own + mate * count;
      for (int n = 0; n < modes_; ++n) team[n] += theirs[n];
    }
    const double* weight = weight_.data() + m * modes_;
    const double* target = target_.data() + m * modes_;
    const double* energy = energy_.data() + m * modes_;
    const double slope = slope_x[m], value = cos_x[m], bend = -wave_x2 * m * m * value;
    for (int n = 0; n < modes_; ++n) {
      const double residual = weight[n] * (team[n] * per_second - target[n]);
      power[n] += residual * residual * energy[n];
      over_bend[n] += bend * residual;
      over_slope[n] += slope * residual;
      over_cos[n] += value * residual;
    }
  }

  FieldAt field;
  double power_sum = 0, xx = 0, xy = 0, yy = 0;
  for (int n = 0; n < modes_; ++n) {
    field.gradient.x() += over_slope[n] * cos_y[n];
    field.gradient.y() += over_cos[n] * slope_y[n];
    xx += over_bend[n] * cos_y[n];
    xy += over_slope[n] * slope_y[n];
    yy -= over_cos[n] * (wave_y2 * n * n * cos_y[n]);
    power_sum += power[n];
  }
  const ControlLaw& law = mission_.law;
  field.hessian << xx, xy, xy, yy;
  const double epsilon = law.epsilon * std::sqrt(power_sum);
  const double length = std::sqrt(field.gradient.squaredNorm() + epsilon * epsilon);
  const Eigen::Vector2d xi =
      normal_pair(mission_.seed, Purpose::kPerturbation, 0, static_cast<std::uint64_t>(tick));
  const Eigen::Vector2d eta = normal_pair(mission_.seed, Purpose::kPush, 0,
                                          static_cast<std::uint64_t>(tick / push_ticks(law, dt_s)));
  return -law.u_max_mps / length * field.gradient -
         law.contraction_gain_per_s * (x_m - law.contraction_center_m) +
         perturbation(law, dt_s, epsilon, field, xi, eta);
}

}  // namespace ergocast::bench
