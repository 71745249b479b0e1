// SPDX-License-Identifier: BSD-3-Clause
// The adaptive perturbation: between its floor and its ceiling, strong across the directions that
// the field leaves open, and nowhere else.
#include "core/law/perturbation.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <numbers>

#include "core/base/noise.h"

namespace ergocast {
namespace {

constexpr double kEpsilon = 2e-5, kFloor = 0.5, kCeiling = 8, kSpeed_mps = 4;

ControlLaw adaptive() {
  ControlLaw law;
  law.perturbation = Perturbation::kAdaptive;
  law.u_max_mps = kSpeed_mps;
  law.noise_intensity = kFloor;
  law.noise_ceiling = kCeiling;
  return law;
}

FieldAt field(const Eigen::Vector2d& gradient, double xx, double xy, double yy) {
  FieldAt at;
  at.gradient.head<2>() = gradient;
  at.hessian.topLeftCorner<2, 2>() << xx, xy, xy, yy;
  return at;
}

/// A step in which the push is held for one step only, so that ξ and η are on a par.
const double kStep_s = std::pow(kCeiling / kSpeed_mps, 2);

/// The intensity along x and along y, with what is off the diagonal: the root of the covariance of
/// one step a second.
Eigen::Matrix2d intensities(const FieldAt& at, double epsilon = kEpsilon) {
  const auto response = [&](const Eigen::Vector2d& xi, const Eigen::Vector2d& eta) {
    const Eigen::Vector3d push =
        perturbation({adaptive(), kStep_s}, epsilon, at, on_ground(xi), on_ground(eta));
    EXPECT_EQ(push.z(), 0);
    return (push.head<2>() * std::sqrt(kStep_s)).eval();
  };
  Eigen::Matrix<double, 2, 4> all;
  all << response({1, 0}, {0, 0}), response({0, 1}, {0, 0}), response({0, 0}, {1, 0}),
      response({0, 0}, {0, 1});
  const Eigen::Matrix2d covariance = all * all.transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(covariance).operatorSqrt();
}

void expect_near(const Eigen::Matrix2d& sigma, double along_x, double along_y) {
  const Eigen::Matrix2d expected = Eigen::Vector2d(along_x, along_y).asDiagonal();
  EXPECT_LT((sigma - expected).norm(), 1e-12 * kCeiling) << sigma;
}

TEST(Perturbation, ItsGreatestDeviationIsThatOfAStepWhereTheFieldIsWhollyOpen) {
  for (const double dt_s : {0.1, kStep_s}) {  // a push held for many steps, and for one
    const auto along_x = [&](double xi, double eta) {
      return perturbation({adaptive(), dt_s}, kEpsilon, field({0, 0}, -1e-7, 0, -2e-7), {xi, 0, 0},
                          {eta, 0, 0})
          .x();
    };
    EXPECT_NEAR(greatest_deviation_mps(adaptive(), dt_s), std::hypot(along_x(1, 0), along_x(0, 1)),
                1e-12);
  }
  EXPECT_NEAR(greatest_deviation_mps(adaptive(), kStep_s), kCeiling / std::sqrt(kStep_s), 1e-12);
  ControlLaw constant = adaptive();
  constant.perturbation = Perturbation::kConstant;
  EXPECT_NEAR(greatest_deviation_mps(constant, 0.25), kFloor / 0.5, 1e-15);
}

TEST(Perturbation, OnARidgeIsStrongAcrossAndWeakAlong) {
  // B points along y, U bends down across: a midline between two peaks.
  expect_near(intensities(field({0, 1e-3}, -4e-7, 0, 1e-7)), kCeiling, kFloor);
}

TEST(Perturbation, InAValleyIsWeak) {
  expect_near(intensities(field({0, 1e-3}, 4e-7, 0, 1e-7)), kFloor, kFloor);
}

TEST(Perturbation, WhereBVanishesOnAPeakIsStrongAllRound) {
  expect_near(intensities(field({0, 0}, -4e-7, 0, -4e-7)), kCeiling, kCeiling);
}

TEST(Perturbation, OfASaddleIsStrongOneWay) {
  expect_near(intensities(field({0, 0}, 4e-7, 0, -4e-7)), kFloor, kCeiling);
}

TEST(Perturbation, FadesAsTheFieldAcrossGrowsBeyondEpsilon) {
  const auto across = [](double part) {
    return intensities(field({part, 1e-3}, -4e-7, 0, 1e-7))(0, 0);
  };
  EXPECT_NEAR(across(kEpsilon), std::sqrt((kFloor * kFloor + kCeiling * kCeiling) / 2), 1e-12);
  EXPECT_NEAR(across(3 * kEpsilon), std::sqrt(0.9 * kFloor * kFloor + 0.1 * kCeiling * kCeiling),
              1e-12);
  EXPECT_NEAR(across(1e4 * kEpsilon), kFloor, 1e-5);
}

TEST(Perturbation, TurnsWithTheField) {
  for (int step = 0; step < 24; ++step) {
    const Eigen::Matrix2d turn =
        Eigen::Rotation2D<double>(step * std::numbers::pi / 12).toRotationMatrix();
    FieldAt at = field({kEpsilon, 1e-3}, -4e-7, 0, 1e-7);
    const Eigen::Matrix2d straight = intensities(at);
    at.gradient.head<2>() = (turn * at.gradient.head<2>()).eval();
    auto hessian = at.hessian.topLeftCorner<2, 2>();
    hessian = (turn * hessian * turn.transpose()).eval();
    const Eigen::Matrix2d expected = turn * straight * turn.transpose();
    EXPECT_LT((intensities(at) - expected).norm(), 1e-6) << step;
  }
}

TEST(Perturbation, IsNeverBelowItsFloorNorAboveItsCeiling) {
  // Theorem 1 needs the lower bound, Theorem 2 the upper one.
  for (std::uint64_t i = 0; i < 20000; ++i) {
    const auto draw = [i](std::uint32_t what) { return normal_pair(7, Purpose::kStart, what, i); };
    const double scale = std::exp(3 * draw(9).x());
    const Eigen::Matrix2d sigma =
        intensities(field(scale * kEpsilon * draw(0), draw(1).x(), draw(1).y(), draw(2).x()));
    const Eigen::Vector2d singular = sigma.jacobiSvd().singularValues();
    ASSERT_LE(singular[0], kCeiling * (1 + 1e-12)) << i;
    ASSERT_GE(singular[1], kFloor * (1 - 1e-12)) << i;
  }
}

TEST(Perturbation, OfNothingIsTheFloor) {
  expect_near(intensities(field({0, 0}, 0, 0, 0), 0), kFloor, kFloor);
}

TEST(Perturbation, WithoutEpsilonAnswersToExactZerosAlone) {
  expect_near(intensities(field({0, 1e-3}, -1, 0, -1), 0), kCeiling, kFloor);
}

TEST(Perturbation, SurvivesResidualsWhoseSquaresVanish) {
  const double across = intensities(field({1e-200, 0}, -1e-190, 0, -1e-190), 1e-200)(0, 0);
  EXPECT_NEAR(across, std::sqrt((kFloor * kFloor + kCeiling * kCeiling) / 2), 1e-12);
}

TEST(Perturbation, ConstantIsSigmaWhateverTheField) {
  ControlLaw law;
  law.noise_intensity = 0.75;
  const Eigen::Vector3d xi(0.3, -2, 0);
  EXPECT_EQ(perturbation({law, 0.125}, 0, field({1, 2}, -1, 0, -1), xi, {5, 7, 0}),
            0.75 / std::sqrt(0.125) * xi);
}

TEST(Perturbation, PushesNoFasterThanTheInput) {
  for (const double dt_s : {0.01, 0.1, 1.0, 3.0, 4.0, 100.0}) {
    EXPECT_EQ(push_ticks(adaptive(), dt_s), std::ceil(4 / dt_s)) << dt_s;
    EXPECT_LE(greatest_push_mps(adaptive(), dt_s), kSpeed_mps) << dt_s;
  }
  EXPECT_NEAR(greatest_push_mps(adaptive(), 0.1), kSpeed_mps, 0.01);
}

TEST(Perturbation, SpreadsLikeItsCeilingOverManyPushes) {
  // Along x on a ridge: the sum over many steps has the variance of the ceiling's Brownian motion.
  constexpr double kDt_s = 0.5;
  constexpr int kTicks = 64, kWalks = 4000;
  const FieldAt ridge = field({0, 1e-3}, -4e-7, 0, 1e-7);
  double square_m2 = 0;
  for (std::uint32_t walk = 0; walk < kWalks; ++walk) {
    double x_m = 0;
    for (Tick n = 0; n < kTicks; ++n) {
      const auto step = static_cast<std::uint64_t>(n);
      const auto push = static_cast<std::uint64_t>(n / push_ticks(adaptive(), kDt_s));
      x_m += kDt_s * perturbation({adaptive(), kDt_s}, kEpsilon, ridge,
                                  on_ground(normal_pair(1, Purpose::kPerturbation, walk, step)),
                                  on_ground(normal_pair(1, Purpose::kPush, walk, push)))
                         .x();
    }
    square_m2 += x_m * x_m / kWalks;
  }
  // A variance from 4000 walks is known to 2.2 % (one standard deviation).
  EXPECT_NEAR(square_m2, kCeiling * kCeiling * kTicks * kDt_s, 0.12 * square_m2);
}

// ---- in space ----

/// A field with these principal directions, the columns of `turn`, curvatures and parts of B.
FieldAt field_along(const Eigen::Matrix3d& turn, const Eigen::Vector3d& curvatures,
                    const Eigen::Vector3d& parts) {
  return {turn * parts, turn * curvatures.asDiagonal() * turn.transpose()};
}

Eigen::Matrix3d some_turn(std::uint64_t i) {
  const Eigen::Vector2d a = normal_pair(3, Purpose::kStart, 0, i),
                        b = normal_pair(3, Purpose::kStart, 1, i);
  return Eigen::Quaterniond(a.x(), a.y(), b.x(), b.y()).normalized().toRotationMatrix();
}

Eigen::Vector3d normals(std::uint32_t who, std::uint64_t i) {
  return normal_in({{0, 0, 0}, {1, 1, 1}}, 5, Purpose::kStart, who, i);
}

/// The sum over known directions, written out.
Eigen::Vector3d pushed(const Eigen::Matrix3d& turn, const Eigen::Vector3d& curvatures,
                       const Eigen::Vector3d& parts, const Eigen::Vector3d& xi,
                       const Eigen::Vector3d& eta) {
  Eigen::Vector3d velocity = kFloor / std::sqrt(kStep_s) * xi;
  for (int i = 0; i < 3; ++i) {
    if (curvatures[i] >= 0) continue;
    const double s = kEpsilon * kEpsilon / (kEpsilon * kEpsilon + parts[i] * parts[i]);
    velocity +=
        std::sqrt(s) * greatest_push_mps(adaptive(), kStep_s) * turn.col(i).dot(eta) * turn.col(i);
  }
  return velocity;
}

TEST(Perturbation, InSpacePushesAlongThePrincipalDirections) {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Eigen::Matrix3d turn = some_turn(i);
    // Apart from each other, so that the directions are certain.
    const Eigen::Vector3d curvatures = Eigen::Vector3d(-3e-7, -1e-7, 2e-7) * (i % 2 == 0 ? 1 : -1);
    const Eigen::Vector3d parts = kEpsilon * normals(0, i), xi = normals(1, i), eta = normals(2, i);
    const Eigen::Vector3d v_mps = perturbation({adaptive(), kStep_s}, kEpsilon,
                                               field_along(turn, curvatures, parts), xi, eta);
    ASSERT_LT((v_mps - pushed(turn, curvatures, parts, xi, eta)).norm(), 1e-11) << i;
  }
}

TEST(Perturbation, OfAFieldThatIsLevelAlongZIsThatOfThePlane) {
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Eigen::Vector3d b = normals(0, i) * kEpsilon, h = normals(1, i) * 1e-7;
    const Eigen::Vector3d xi = normals(2, i), eta = normals(3, i);
    FieldAt level = field(b.head<2>(), h.x(), h.y(), h.z());
    const PerturbationScale scale{adaptive(), kStep_s};
    const Eigen::Vector3d plane = perturbation(scale, kEpsilon, level, xi, eta);
    EXPECT_EQ(plane.z(), scale.noise_mps * xi.z());
    level.hessian(2, 2) = 1e-300;  // almost 0, but enough to take the path for space
    const Eigen::Vector3d space = perturbation(scale, kEpsilon, level, xi, eta);
    ASSERT_LT((plane - space).norm(), 1e-9) << i;
  }
}

TEST(Perturbation, InSpaceWhereBVanishesOnAPeakIsStrongAllRound) {
  const Eigen::Vector3d eta(0.3, -0.7, 1.1);
  FieldAt peak;
  peak.hessian = -4e-7 * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d v_mps =
      perturbation({adaptive(), kStep_s}, kEpsilon, peak, Eigen::Vector3d::Zero(), eta);
  EXPECT_LT((v_mps - greatest_push_mps(adaptive(), kStep_s) * eta).norm(), 1e-12);
}

}  // namespace
}  // namespace ergocast
