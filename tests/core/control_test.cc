// SPDX-License-Identifier: BSD-3-Clause
// The control step against the paper's formulas written out term by term, and B against the slope
// of φ² itself.
#include "core/law/control.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "tests/core/uneven_mission.h"

namespace ergocast {
namespace {

/// B, term by term, with the library's cosines and sines.
Eigen::Vector3d reference_gradient(const Mission& mission, const Eigen::Vector3d& x_m,
                                   const Coefficients& coverage) {
  Eigen::Vector3d b(0, 0, 0);
  const Eigen::Vector3d x = x_m - mission.domain.origin_m, size = mission.domain.size_m;
  for (int m = 0; m < mission.basis.modes_x; ++m) {
    for (int n = 0; n < mission.basis.modes_y; ++n) {
      const double kx = m * std::numbers::pi / size.x(), ky = n * std::numbers::pi / size.y();
      const double k = std::sqrt(m * m + n * n), s = mission.basis.sobolev_exponent;
      const bool squared = mission.basis.sobolev_form == SobolevForm::kSquaredNorm;
      double lambda = squared ? std::pow(1 + k * k, -s) : std::pow(1 + k, -s);
      if (mission.basis.normalized) {
        lambda /= size.x() * (m > 0 ? 0.5 : 1) * size.y() * (n > 0 ? 0.5 : 1);
      }
      const double a = lambda * (in_plane(coverage, mission.basis)(m, n) -
                                 in_plane(mission.target_coefficients, mission.basis)(m, n));
      b.x() -= a * kx * std::sin(kx * x.x()) * std::cos(ky * x.y());
      b.y() -= a * ky * std::cos(kx * x.x()) * std::sin(ky * x.y());
    }
  }
  return b;
}

/// RMS of ‖Σ a ∇f‖ over the domain stretched to a square, by midpoints, of which twice the highest
/// mode are exact.
double reference_rms(const Mission& mission, const Coefficients& coverage) {
  constexpr int kPoints = 24;
  double sum = 0;
  for (int i = 0; i < kPoints; ++i) {
    for (int j = 0; j < kPoints; ++j) {
      const Eigen::Vector3d share((i + 0.5) / kPoints, (j + 0.5) / kPoints, 0);
      const Eigen::Vector3d x_m =
          mission.domain.origin_m + share.cwiseProduct(mission.domain.size_m);
      const Eigen::Vector3d gradient = reference_gradient(mission, x_m, coverage);
      sum += gradient.cwiseProduct(mission.domain.size_m).squaredNorm();
    }
  }
  return std::sqrt(sum) / kPoints / mission.domain.size_m.maxCoeff();
}

Eigen::Vector3d reference_command(const Mission& mission, AgentId agent, Tick tick,
                                  const Eigen::Vector3d& x_m, const Coefficients& coverage,
                                  double rms) {
  const ControlLaw& law = mission.law;
  const Eigen::Vector3d b = reference_gradient(mission, x_m, coverage);
  const bool relative = law.regularization == Regularization::kRelative;
  const double epsilon = law.epsilon * (relative ? rms : 1);
  const double length = std::sqrt(b.squaredNorm() + epsilon * epsilon);
  Eigen::Vector3d v =
      length == 0 ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(-law.u_max_mps * b / length);
  v -= law.contraction_gain_per_s * (x_m - law.contraction_center_m);
  v += law.noise_intensity / std::sqrt(mission.timing.dt_s) *
       on_ground(normal_pair(mission.seed, Purpose::kPerturbation,
                             static_cast<std::uint32_t>(agent), static_cast<std::uint64_t>(tick)));
  return v;
}

std::vector<Mission> every_law() {
  std::vector<Mission> missions;
  for (const SobolevForm form : {SobolevForm::kSquaredNorm, SobolevForm::kNorm}) {
    for (const bool normalized : {false, true}) {
      for (const Regularization how : {Regularization::kAbsolute, Regularization::kRelative}) {
        for (const double epsilon : {0.0, 0.25}) {
          Mission mission = uneven_mission();
          mission.basis.sobolev_form = form;
          mission.basis.sobolev_exponent = 1.25;
          mission.basis.normalized = normalized;
          mission.law.regularization = how;
          // Absolute: in the unit of B, which the norm of the modes changes too.
          mission.law.epsilon =
              how == Regularization::kRelative ? epsilon : epsilon * (normalized ? 1e-9 : 1e-3);
          mission.law.contraction_gain_per_s = 2e-3;
          mission.law.contraction_center_m = {40, 700, 0};
          mission.law.noise_intensity = 0.5;
          missions.push_back(mission);
        }
      }
    }
  }
  return missions;
}

TEST(Command, IsThePapersLawTermByTerm) {
  for (const Mission& mission : every_law()) {
    Controller controller(mission);
    const Coefficients coverage = coverage_of(mission, 50);
    const double rms = reference_rms(mission, coverage);
    for (std::uint64_t i = 0; i < 20; ++i) {
      const Eigen::Vector3d x_m = place_in(mission.domain, 1000 + i);
      const auto tick = static_cast<Tick>(i);
      const Eigen::Vector3d v = command_at(controller, mission, x_m, coverage, 3, tick);
      const Eigen::Vector3d b = reference_gradient(mission, x_m, coverage);
      // B is a sum of 63 terms of at most a few RMS, each with 20 roundings of its cosines; where
      // the terms nearly cancel, its direction is that much less certain.
      const double bound = 63 * 20 * kRounding * (1 + rms / b.norm());
      EXPECT_LE((controller.spectral_gradient() - b).norm(), bound * b.norm());
      EXPECT_LE((v - reference_command(mission, 3, tick, x_m, coverage, rms)).norm(), bound * 20);
    }
  }
}

TEST(Command, IsThatOfAControllerOfItsOwnWhereOneServesManyAgents) {
  for (const Mission& mission : every_law()) {
    Controller shared(mission);
    const Coefficients coverage = coverage_of(mission, 50);
    for (Tick tick = 0; tick < 3; ++tick) {
      for (const AgentId agent : {7, 3, 12345, 0, 2, 1}) {
        Controller own(mission);
        const Eigen::Vector3d x_m = place_in(mission.domain, 2000 + static_cast<unsigned>(agent));
        EXPECT_EQ(command_at(shared, mission, x_m, coverage, agent, tick),
                  command_at(own, mission, x_m, coverage, agent, tick))
            << agent;
      }
    }
  }
}

TEST(Command, GradientIsTheSlopeOfPhiSquaredInTheNewestSample) {
  // With S the sum before the sample and T the time after it, c = (S + f(x) dt) / T, so that
  // ∂φ²/∂x = 2 dt/T Σ λ (c − μ) ∇f = 2 dt/T · B.
  for (Mission mission : every_law()) {
    mission.law = {};
    Controller controller(mission);
    constexpr int kBefore = 7;
    const Coefficients before = coverage_of(mission, kBefore) * kBefore;
    const auto coverage_with = [&](const Eigen::Vector3d& x_m) -> Coefficients {
      return (before + basis_values(x_m, mission.domain, mission.basis)) / (kBefore + 1);
    };
    const auto metric_with = [&](const Eigen::Vector3d& x_m) {
      return controller.metric(coverage_with(x_m));
    };
    const Eigen::Vector3d x_m(512.5, 640.25, 0);  // dyadic, so that x ± h is exact
    const double h = 0.0625;
    const Coefficients coverage = coverage_with(x_m);
    command_at(controller, mission, x_m, coverage);
    const Eigen::Vector3d slope = 2 * controller.spectral_gradient() / (kBefore + 1);

    // h²/6 of the third derivative, ≤ Σ λ (2 |c − μ| k³ + 6 k³)/8 with |c| changing by at most 1/8
    // for each k; and the rounding of φ², 63 terms, over h.
    const Coefficients weights = sobolev_weights(mission.basis, mission.domain);
    double third = 0;
    for (int m = 0; m < 9; ++m) {
      for (int n = 0; n < 7; ++n) {
        const double k = std::hypot(m * std::numbers::pi / 2000, n * std::numbers::pi / 1200);
        const int i = 7 * m + n;
        third += weights[i] * k * k * k *
                 (2 * std::abs(coverage[i] - mission.target_coefficients[i]) + 6.0 / 8) / 8;
      }
    }
    const double bound = h * h / 6 * third + 63 * 20 * kRounding * controller.metric(coverage) / h;
    ASSERT_LT(bound, 1e-4 * slope.norm()) << "the comparison is worth it";
    for (int axis = 0; axis < 2; ++axis) {
      const Eigen::Vector3d step = h * Eigen::Vector3d::Unit(axis);
      EXPECT_NEAR(slope[axis], (metric_with(x_m + step) - metric_with(x_m - step)) / (2 * h),
                  bound);
    }
  }
}

TEST(Command, LowersPhiSquaredOfTheNextSample) {
  Mission mission = uneven_mission();
  Controller controller(mission);
  const Coefficients before = coverage_of(mission, 10) * 10;
  const Eigen::Vector3d x_m(512.5, 640.25, 0);
  const auto metric_after = [&](const Eigen::Vector3d& next_m) {
    return controller.metric((before + basis_values(next_m, mission.domain, mission.basis)) / 11);
  };
  const Coefficients now = (before + basis_values(x_m, mission.domain, mission.basis)) / 11;
  const Eigen::Vector3d step = command_at(controller, mission, x_m, now) * mission.timing.dt_s;
  EXPECT_LT(metric_after(x_m + step), metric_after(x_m));
  EXPECT_GT(metric_after(x_m - step), metric_after(x_m));
}

TEST(RelativeEpsilon, IsAShareOfTheResidualGradientsRms) {
  for (Mission mission : every_law()) {
    mission.law.regularization = Regularization::kRelative;
    mission.law.epsilon = 0.2;
    Controller controller(mission);
    const Coefficients coverage = coverage_of(mission, 30);
    command_at(controller, mission, {100, 600, 0}, coverage);
    // 576 squares of 63 terms, 20 roundings each.
    const double expected = 0.2 * reference_rms(mission, coverage);
    EXPECT_NEAR(controller.epsilon(), expected, (576 + 63 * 20) * kRounding * expected);
  }
}

}  // namespace
}  // namespace ergocast
