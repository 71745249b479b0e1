// SPDX-License-Identifier: BSD-3-Clause
// Coefficients of targets of every kind, by a hash of their bits that every processor must give:
// `verify` compiles a scenario again, perhaps on another processor.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <vector>

#include "target/raster_integral.h"
#include "target/target.h"
#include "target/trapezoids.h"

namespace ergocast {
namespace {

std::uint64_t hash_of(const double* values, Eigen::Index count) {
  std::uint64_t hash = 0;
  for (Eigen::Index i = 0; i < count; ++i)
    hash = (hash ^ std::bit_cast<std::uint64_t>(values[i])) * 0x9e3779b97f4a7c15;
  return hash;
}

std::uint64_t hash_of(const TargetDensity& target, const Box& domain, const Basis& basis) {
  const Coefficients values = target_coefficients(target, domain, basis).values;
  return hash_of(values.data(), values.size());
}

Box domain_of(double height_m) { return {{-300, 50, -5}, {2000, 1200, height_m}}; }

Gaussian bell(double mean_x_m, const Eigen::Vector3d& deviation_m, double correlation_xy,
              double correlation_xz) {
  Eigen::Matrix3d correlations;
  correlations << 1, correlation_xy, correlation_xz, correlation_xy, 1, 0, correlation_xz, 0, 1;
  return {
      0.7, {mean_x_m, 600, 20}, deviation_m.asDiagonal() * correlations * deviation_m.asDiagonal()};
}

const Ring kPentagon{{0, 100}, {900, 200}, {1100, 900}, {400, 600}, {-100, 1000}};
const Ring kTriangle{{300, 300}, {500, 320}, {420, 480}};

TEST(BitsOfTargets, InAPlaneAreThoseOfEveryProcessor) {
  const Box plane = domain_of(0);
  const Basis basis{.modes_x = 24, .modes_y = 17};
  const Eigen::Vector3d deviation_m(140, 90, 1);
  EXPECT_EQ(hash_of({{bell(500, deviation_m, 0, 0)}, 0.2}, plane, basis), 0xfe327bed39319581u);
  EXPECT_EQ(hash_of({{bell(900, deviation_m, 0.6, 0)}, 0}, plane, basis), 0xcd3130c42a9031acu);
  EXPECT_EQ(hash_of({{}, 0, {{3, {kPentagon, {kTriangle}}}}}, plane, basis), 0xede4d91875e0a7dbu);
  EXPECT_EQ(
      hash_of({{bell(400, deviation_m, -0.3, 0)}, 0.1, {}, {{{kTriangle, {}}}}}, plane, basis),
      0x6e11b296d333724eu);
}

TEST(BitsOfTargets, InABoxAreThoseOfEveryProcessor) {
  const Box box = domain_of(60);
  const Basis basis{.modes_x = 9, .modes_y = 8, .modes_z = 5};
  const Eigen::Vector3d deviation_m(140, 90, 12);
  EXPECT_EQ(hash_of({{bell(700, deviation_m, 0, 0)}, 0.2}, box, basis), 0xf50f2df5cc1dc3beu);
  EXPECT_EQ(hash_of({{bell(700, deviation_m, 0.4, 0.5)}, 0}, box, basis), 0x22f73af985028c8du);
  EXPECT_EQ(hash_of({{}, 0.3, {{1, {kPentagon, {}}, {0, 30}}}}, box, basis), 0x7be66bb4f71bb06cu);
}

TEST(BitsOfTargets, OfAMapAreThoseOfEveryProcessor) {
  const Eigen::Vector2d size_m(2000, 1200);
  const std::vector<Polygon> keep_outs{{kTriangle, {}}};
  RasterIntegral raster({{{-50, 30}, {1900, 1300}}, 41, 29}, size_m, {.modes_x = 24, .modes_y = 17},
                        free_area(size_m, keep_outs));
  for (int row = 0; row < 29; ++row) {
    std::vector<double> values;
    for (int column = 0; column < 41; ++column) values.push_back((row * 7 + column * 13) % 11);
    raster.add_row(row, values);
  }
  const PlaneCoefficients shares = raster.shares().values;
  EXPECT_EQ(hash_of(shares.data(), shares.size()), 0xd6f198a2c0608ae0u);
}

}  // namespace
}  // namespace ergocast
