// SPDX-License-Identifier: BSD-3-Clause
// Domains as people write them: decimal fractions, from a millimetre to a thousand kilometres. The
// coefficients of every part of a target agree there with quadrature, which counts from the
// domain's corner.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <string>

#include "tests/target/plane_target.h"
#include "tests/target/polygon_reference.h"

namespace ergocast {
namespace {

using namespace test;

/// How far a μ_k may be from its quadrature.
constexpr double kMostError = 1e-10;

/// A number with three digits, as a person writes it.
double written(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return std::stod(text);
}

/// Targets whose parts are at the same shares of any domain.
class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {
    const double scale_m = std::pow(10, between(-3, 6));
    for (int axis = 0; axis < 3; ++axis) {
      domain_.size_m[axis] = written(scale_m * between(0.3, 1));
      domain_.origin_m[axis] = written(scale_m * between(-3, 3));
    }
  }

  double between(double low, double high) {
    return std::uniform_real_distribution(low, high)(random_);
  }
  const Box& domain() const { return domain_; }
  Rectangle base() const { return base_of(domain_); }

  Eigen::Vector3d at(double x, double y, double z) const {
    return domain_.origin_m + Eigen::Vector3d(x, y, z).cwiseProduct(domain_.size_m);
  }
  /// A box with a corner anywhere in [0.1, 0.4]², and a size up to 0.5.
  Polygon box() {
    const double x = between(0.1, 0.4), y = between(0.1, 0.4), w = between(0.1, 0.5),
                 h = between(0.1, 0.5);
    return polygon({{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}});
  }
  Polygon triangle() {
    return polygon({{between(0.1, 0.3), between(0.1, 0.3)},
                    {between(0.6, 0.9), between(0.1, 0.3)},
                    {between(0.1, 0.9), between(0.6, 0.9)}});
  }
  /// A band from edge to edge. Rounding decides on which side of the edges its corners are.
  Polygon band() {
    const double y = between(0.1, 0.4), h = between(0.1, 0.5);
    return polygon({{0, y}, {1, y}, {1, y + h}, {0, y + h}});
  }
  Heights heights() {
    const double low = between(0.1, 0.4);
    return {at(0, 0, low).z(), at(0, 0, low + between(0.1, 0.5)).z()};
  }
  Gaussian gaussian(double xy, double xz, double yz) {
    Eigen::Matrix3d correlation = Eigen::Matrix3d::Identity();
    correlation(0, 1) = correlation(1, 0) = xy;
    correlation(0, 2) = correlation(2, 0) = xz;
    correlation(1, 2) = correlation(2, 1) = yz;
    const Eigen::Vector3d deviation_m = domain_.size_m.cwiseProduct(
        Eigen::Vector3d(between(0.2, 0.5), between(0.2, 0.5), between(0.2, 0.5)));
    return {0.7, at(between(0.2, 0.8), between(0.2, 0.8), between(0.2, 0.8)),
            deviation_m.asDiagonal() * correlation * deviation_m.asDiagonal()};
  }

 private:
  Polygon polygon(const Ring& shares) const {
    Ring ring;
    for (const Eigen::Vector2d& share : shares)
      ring.push_back(at(share.x(), share.y(), 0).head<2>());
    return {ring, {}};
  }

  std::mt19937 random_;
  Box domain_;
};

/// ∫ f_mn density over a ring, from the domain's corner.
PlaneCoefficients over(const Ring& ring, const Density& density, const Draw& draw,
                       const Basis& basis) {
  return over_ring(from_corner({ring, {}}, draw.base().origin_m).outline, density,
                   {{0, 0}, draw.base().size_m}, basis, basis.planar() ? 12 : 7);
}
Ring whole(const Draw& draw) {
  const Eigen::Vector2d low = draw.at(0, 0, 0).head<2>(), high = draw.at(1, 1, 0).head<2>();
  return {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
}

/// The mean of a density over the heights where a part stands, times f_l, by Gauss's rule.
Coefficients over_heights(const Draw& draw, const Basis& basis, const Heights& heights,
                          const std::function<PlaneCoefficients(double z_m)>& plane) {
  constexpr int kPanels = 12;
  constexpr double kNode[] = {-0.906179845938664, -0.5384693101056831, 0, 0.5384693101056831,
                              0.906179845938664};
  constexpr double kWeight[] = {0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                0.4786286704993665, 0.2369268850561891};
  const Heights above = above_floor(heights, draw.domain());
  const double half_m = above.length_m() / (2 * kPanels);
  Coefficients sum = Coefficients::Zero(basis.mode_count());
  for (int i = 0; i < 5 * kPanels; ++i) {
    const double z_m = above.low_m + half_m * (2 * (i / 5) + 1 + kNode[i % 5]);
    const PlaneIntegrals at_height{half_m * kWeight[i % 5] * plane(z_m), 0};
    Eigen::VectorXd along_z(basis.modes_z);
    for (int l = 0; l < basis.modes_z; ++l)
      along_z[l] = std::cos(l * std::numbers::pi * z_m / draw.domain().size_m.z());
    TargetCoefficients term{Coefficients::Zero(basis.mode_count()), 0};
    add_product(1, at_height, along_z, term);
    sum += term.values;
  }
  return sum;
}

class FractionalDomains : public ::testing::TestWithParam<int> {
 protected:
  Draw draw_{static_cast<unsigned>(GetParam())};
};

TEST_P(FractionalDomains, OfAPlaneHaveTheirWholeTargetBesideKeepOuts) {
  const Basis basis{.modes_x = 6, .modes_y = 5};
  const Box domain = plane_of(draw_.base());
  const Gaussian round = draw_.gaussian(0, 0, 0), leaning = draw_.gaussian(0.6, 0, 0);
  for (const Polygon& keep_out : {draw_.box(), draw_.triangle(), draw_.band()}) {
    const TargetDensity target{{round, leaning}, 0.4, {}, {{keep_out, {}}}};
    const Density density = [&](const Eigen::Vector2d& x_m) {
      TargetDensity smooth = from_corner(target, domain);
      smooth.keep_outs.clear();
      return density_unscaled(smooth, {{0, 0, 0}, domain.size_m}, on_ground(x_m));
    };
    const PlaneCoefficients expected =
        over(whole(draw_), density, draw_, basis) - over(keep_out.outline, density, draw_, basis);
    const PlaneIntegrals ours = target_integrals(target, draw_.base(), basis);
    EXPECT_LE(largest_difference(ours.values, expected), kMostError);
    EXPECT_LE(ours.error_bound, kMostError);
  }
}

TEST_P(FractionalDomains, OfAPlaneHaveTheirRegions) {
  const Basis basis{.modes_x = 6, .modes_y = 5};
  for (const Polygon& region : {draw_.box(), draw_.triangle(), draw_.band()}) {
    const TargetDensity target{{}, 0, {{2, region, {}}}};
    const double density = 2 / area_m2(region);
    const PlaneCoefficients expected = over(
        region.outline, [&](const Eigen::Vector2d&) { return density; }, draw_, basis);
    const PlaneIntegrals ours = target_integrals(target, draw_.base(), basis);
    EXPECT_LE(largest_difference(ours.values, expected), kMostError);
  }
}

// Regions and keep-outs at their own heights, and a Gaussian whose mean moves with the height.
TEST_P(FractionalDomains, OfABoxHaveTheirWholeTarget) {
  const Basis basis{.modes_x = 4, .modes_y = 3, .modes_z = 4};
  const Gaussian oblique = draw_.gaussian(0.2, 0.5, -0.4);
  const KeepOut keep_out{draw_.box(), draw_.heights()};
  const Region region{1.5, draw_.triangle(), draw_.heights()};
  const Box here{{0, 0, 0}, draw_.domain().size_m};
  const auto density_at = [&](double uniform_weight) {
    const TargetDensity smooth = from_corner({{oblique}, uniform_weight}, draw_.domain());
    return [smooth, here](double z_m) {
      return [smooth, here, z_m](const Eigen::Vector2d& x_m) {
        return density_unscaled(smooth, here, {x_m.x(), x_m.y(), z_m});
      };
    };
  };
  const auto density = density_at(0.4);
  const Coefficients all = over_heights(draw_, basis, heights_of(draw_.domain()), [&](double z_m) {
    return over(whole(draw_), density(z_m), draw_, basis);
  });
  const Coefficients kept_out = over_heights(draw_, basis, keep_out.heights, [&](double z_m) {
    return over(keep_out.polygon.outline, density(z_m), draw_, basis);
  });
  const TargetDensity smooth{{oblique}, 0.4}, cut{{oblique}, 0.4, {}, {keep_out}};
  const auto off = [&](const TargetDensity& target, const Coefficients& expected) {
    return (target_integrals(target, draw_.domain(), basis).values - expected)
        .cwiseAbs()
        .maxCoeff();
  };
  EXPECT_LE(off(smooth, all), kMostError);
  EXPECT_LE(off(cut, all - kept_out), kMostError);
  const double solid = region.weight / (area_m2(region.polygon) * region.heights.length_m());
  const Coefficients prism = over_heights(draw_, basis, region.heights, [&](double) {
    return over(
        region.polygon.outline, [&](const Eigen::Vector2d&) { return solid; }, draw_, basis);
  });
  EXPECT_LE(off({{}, 0, {region}}, prism), kMostError);
}

TEST_P(FractionalDomains, HaveAPictureOfTheirMass) {
  const Box planar = plane_of(draw_.base());
  const TargetDensity target{
      {}, 0.4, {{1.5, draw_.triangle(), {}}}, {{draw_.box(), {}}, {draw_.band(), {}}}};
  const DensityGrid picture = picture_of(target, planar, 97, 64);
  EXPECT_NEAR(picture.mean() * planar.content(), mass_inside(target, planar), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Random, FractionalDomains, ::testing::Range(1, 41));

// Found in the field: −15.6 + 31.7 is 16.1, and 16.1 + 15.6 is more than 31.7.
TEST(FractionalDomain, HasWhatIsAboveItsHighestCorner) {
  const Rectangle domain{{0, -15.6}, {40, 31.7}};
  const Polygon keep_out{{{18, -11}, {20, -11}, {20, -10}, {18, -10}}, {}};
  EXPECT_NEAR(mass_inside({{}, 1, {}, {{keep_out, {}}}}, domain), 1 - 2 / (40 * 31.7), 1e-14);
}

TEST(FractionalDomain, HasItsObliqueGaussian) {
  const Box domain{{0, -15.6, 0}, {40, 31.7, 10}};
  Gaussian oblique{1, {20, 0, 5}};
  oblique.covariance_m2(1, 2) = oblique.covariance_m2(2, 1) = 0.5;
  EXPECT_NEAR(mass_inside({{oblique}, 0}, domain), 1, 1e-6);
}

}  // namespace
}  // namespace ergocast
