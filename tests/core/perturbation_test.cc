// The adaptive perturbation: between its floor and its ceiling, strong across the directions that
// the field leaves open, and nowhere else.
#include "core/perturbation.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <cmath>
#include <numbers>

#include "core/noise.h"

namespace ergocast {
namespace {

constexpr double kEpsilon = 2e-5, kFloor = 0.5, kCeiling = 8;

ControlLaw adaptive() {
  ControlLaw law;
  law.perturbation = Perturbation::kAdaptive;
  law.noise_intensity = kFloor;
  law.noise_ceiling = kCeiling;
  return law;
}

FieldAt field(const Eigen::Vector2d& gradient, double xx, double xy, double yy) {
  FieldAt at;
  at.gradient = gradient;
  at.hessian << xx, xy, xy, yy;
  return at;
}

/// The response to ξ along x and along y, as a matrix; dt = 1, so that σ is what comes out.
Eigen::Matrix2d intensities(const FieldAt& at, double epsilon = kEpsilon) {
  Eigen::Matrix2d sigma;
  sigma << perturbation(adaptive(), 1, epsilon, at, {1, 0}),
      perturbation(adaptive(), 1, epsilon, at, {0, 1});
  return sigma;
}

Eigen::Matrix2d diagonal(double along_x, double along_y) {
  return Eigen::Vector2d(along_x, along_y).asDiagonal();
}

TEST(Perturbation, OnARidgeIsStrongAcrossAndWeakAlong) {
  // B points along y, U bends down across: a midline between two peaks.
  EXPECT_EQ(intensities(field({0, 1e-3}, -4e-7, 0, 1e-7)), diagonal(kCeiling, kFloor));
}

TEST(Perturbation, InAValleyIsWeak) {
  EXPECT_EQ(intensities(field({0, 1e-3}, 4e-7, 0, 1e-7)), diagonal(kFloor, kFloor));
}

TEST(Perturbation, WhereBVanishesOnAPeakIsStrongAllRound) {
  EXPECT_EQ(intensities(field({0, 0}, -4e-7, 0, -4e-7)), diagonal(kCeiling, kCeiling));
}

TEST(Perturbation, OfASaddleIsStrongOneWay) {
  EXPECT_EQ(intensities(field({0, 0}, 4e-7, 0, -4e-7)), diagonal(kFloor, kCeiling));
}

TEST(Perturbation, FadesAsTheFieldAcrossGrowsBeyondEpsilon) {
  const auto across = [](double part) {
    return intensities(field({part, 1e-3}, -4e-7, 0, 1e-7))(0, 0);
  };
  EXPECT_DOUBLE_EQ(across(kEpsilon), std::sqrt((kFloor * kFloor + kCeiling * kCeiling) / 2));
  EXPECT_DOUBLE_EQ(across(3 * kEpsilon),
                   std::sqrt(0.9 * kFloor * kFloor + 0.1 * kCeiling * kCeiling));
  EXPECT_NEAR(across(1e4 * kEpsilon), kFloor, 1e-5);
}

TEST(Perturbation, TurnsWithTheField) {
  for (int step = 0; step < 24; ++step) {
    const Eigen::Matrix2d turn =
        Eigen::Rotation2D<double>(step * std::numbers::pi / 12).toRotationMatrix();
    FieldAt at = field({kEpsilon, 1e-3}, -4e-7, 0, 1e-7);
    const Eigen::Matrix2d straight = intensities(at);
    at.gradient = turn * at.gradient;
    at.hessian = turn * at.hessian * turn.transpose();
    const Eigen::Matrix2d expected = turn * straight * turn.transpose();
    EXPECT_LT((intensities(at) - expected).norm(), 1e-6) << step;
  }
}

TEST(Perturbation, IsNeverBelowItsFloorNorAboveItsCeiling) {
  // Theorem 1 wants the one, Theorem 2 the other.
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
  EXPECT_EQ(intensities(field({0, 0}, 0, 0, 0), 0), diagonal(kFloor, kFloor));
}

TEST(Perturbation, WithoutEpsilonAnswersToExactZerosAlone) {
  EXPECT_EQ(intensities(field({0, 1e-3}, -1, 0, -1), 0), diagonal(kCeiling, kFloor));
}

TEST(Perturbation, SurvivesResidualsWhoseSquaresVanish) {
  EXPECT_EQ(intensities(field({1e-200, 0}, -1e-190, 0, -1e-190), 1e-200).allFinite(), true);
  const double across = intensities(field({1e-200, 0}, -1e-190, 0, -1e-190), 1e-200)(0, 0);
  EXPECT_DOUBLE_EQ(across, std::sqrt((kFloor * kFloor + kCeiling * kCeiling) / 2));
}

TEST(Perturbation, ConstantIsSigmaWhateverTheField) {
  ControlLaw law;
  law.noise_intensity = 0.75;
  const Eigen::Vector2d xi(0.3, -2);
  EXPECT_EQ(perturbation(law, 0.125, 0, field({1, 2}, -1, 0, -1), xi), 0.75 / std::sqrt(0.125) * xi);
}

}  // namespace
}  // namespace ergocast
