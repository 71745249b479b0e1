// SPDX-License-Identifier: BSD-3-Clause
// Checks Gaussians, regions, keep-outs and maps one by one, each under its own path.
#include "scenario/validate_target.h"

#include <algorithm>
#include <cmath>

#include "scenario/convert.h"
#include "scenario/polygon_flaw.h"
#include "target/map_file.h"

namespace ergocast {
namespace {

constexpr Range kSigmaPerSide = limits::between(1e-4, 1e4);
constexpr int kMaxGaussians = 64;
constexpr int kMaxMaps = 16;
constexpr int kMaxRegions = 64;
constexpr int kMaxKeepOuts = 64;
/// Above this the ridge is too narrow for the quadrature of μ.
constexpr double kMaxCorrelation = 0.99;

class TargetValidator {
 public:
  TargetValidator(const proto::Scenario& scenario, Checks& checks)
      : target_(scenario.target()), checks_(checks) {
    if (!checks.sound("domain")) return;
    longer_side_m_ = domain_of(scenario.domain()).size_m.maxCoeff();
  }

  void run() {
    at_most("Gaussians", target_.gaussians_size(), kMaxGaussians);
    at_most("maps", target_.maps_size(), kMaxMaps);
    at_most("regions", target_.regions_size(), kMaxRegions);
    at_most("keep-outs", target_.keep_outs_size(), kMaxKeepOuts);
    for (int i = 0; i < target_.gaussians_size(); ++i) {
      width(target_.gaussians(i), indexed("target.gaussians", i));
    }
    for (int i = 0; i < target_.maps_size(); ++i) map(target_.maps(i), indexed("target.maps", i));
    polygons();
    if (target_.gaussians_size() == 0 && target_.uniform_weight() == 0 &&
        target_.maps_size() == 0 && target_.regions_size() == 0) {
      checks_.missing("target", "there is nothing to cover",
                      "add gaussians { }, maps { }, regions { } or a uniform_weight above 0");
    }
  }

 private:
  void at_most(const std::string& what, int count, int limit) {
    if (count <= limit) return;
    checks_.problem(
        "target",
        std::to_string(count) + " " + what + " are above the limit " + std::to_string(limit),
        "leave out the least important");
  }

  // Gaussians.

  void width(const proto::Gaussian& gaussian, const std::string& path) {
    if (gaussian.has_sigma_m() == gaussian.has_covariance()) {
      if (gaussian.has_sigma_m()) {
        return checks_.problem(path, "has both sigma_m and covariance", "keep one of them");
      }
      if (!checks_.sound(path + ".sigma_m") || !checks_.sound(path + ".covariance")) return;
      return checks_.problem(path, "has no width", "add sigma_m or covariance { }");
    }
    if (gaussian.has_sigma_m()) return deviation(path + ".sigma_m", gaussian.sigma_m());
    if (checks_.sound(path + ".covariance")) {
      covariance(gaussian.covariance(), path + ".covariance");
    }
  }

  void deviation(const std::string& path, double sigma_m) {
    if (!checks_.sound(path) || longer_side_m_ == 0) return;
    checks_.in_range(
        path, sigma_m,
        limits::between(kSigmaPerSide.low * longer_side_m_, kSigmaPerSide.high * longer_side_m_));
  }

  void covariance(const proto::Covariance& c, const std::string& path) {
    const double limit_m2 = kMaxCorrelation * std::sqrt(c.xx_m2()) * std::sqrt(c.yy_m2());
    if (!(std::abs(c.xy_m2()) <= limit_m2)) {
      return checks_.problem(
          path + ".xy_m2",
          shortest(c.xy_m2()) + " leaves too little for the covariance to be positive " +
              "definite: the limit is " + shortest(kMaxCorrelation) + " sqrt(xx_m2 yy_m2)",
          "write " + shortest(-rounded_down(limit_m2)) + " to " + shortest(rounded_down(limit_m2)));
    }
    if (longer_side_m_ == 0) return;
    variance(path + ".xx_m2", c.xx_m2());
    variance(path + ".yy_m2", c.yy_m2());
  }

  void variance(const std::string& path, double variance_m2) {
    const double low_m = kSigmaPerSide.low * longer_side_m_;
    const double high_m = kSigmaPerSide.high * longer_side_m_;
    checks_.in_range(path, variance_m2, limits::between(low_m * low_m, high_m * high_m));
  }

  // Maps.

  void map(const proto::Map& map, const std::string& path) {
    if (!map.has_file() || map.file().empty()) {
      return checks_.missing(path + ".file", "is missing", "add the name of a .png, .csv or .asc");
    }
    const std::optional<MapKind> kind = map_kind(map.file());
    if (!kind) {
      return checks_.problem(path + ".file", map.file() + " does not end in .png, .csv or .asc",
                             "write the map as one of these");
    }
    const bool states_extent = *kind == MapKind::kAsciiGrid;
    extent(path + ".origin_x_m", map.has_origin_x_m(), states_extent);
    extent(path + ".origin_y_m", map.has_origin_y_m(), states_extent);
    extent(path + ".size_x_m", map.has_size_x_m(), states_extent);
    extent(path + ".size_y_m", map.has_size_y_m(), states_extent);
    if (states_extent && map.first_row() == proto::Map::SOUTH) {
      checks_.problem(path + ".first_row", "an ESRI ASCII grid always begins in the north",
                      "remove it");
    }
  }

  void extent(const std::string& path, bool present, bool stated_by_file) {
    if (present && stated_by_file) {
      checks_.problem(path, "an ESRI ASCII grid states its own extent", "remove it");
    } else if (!present && !stated_by_file) {
      checks_.missing(path, "is missing",
                      "say where the map lies: origin_x_m, origin_y_m, size_x_m, size_y_m");
    }
  }

  // Polygons.

  void polygons() {
    int vertices = 0;
    const auto count = [&](const proto::Polygon& polygon) {
      vertices += polygon.vertices_size();
      for (const proto::Ring& hole : polygon.holes()) vertices += hole.vertices_size();
    };
    for (const proto::Region& region : target_.regions()) count(region.polygon());
    for (const proto::Polygon& keep_out : target_.keep_outs()) count(keep_out);
    if (vertices > kMaxVertices) {
      return checks_.problem("target",
                             std::to_string(vertices) + " vertices are above the limit " +
                                 std::to_string(kMaxVertices),
                             "draw the polygons with fewer");
    }
    for (int i = 0; i < target_.regions_size(); ++i) {
      polygon(target_.regions(i).polygon(), indexed("target.regions", i) + ".polygon");
    }
    for (int i = 0; i < target_.keep_outs_size(); ++i) {
      polygon(target_.keep_outs(i), indexed("target.keep_outs", i));
    }
  }

  void polygon(const proto::Polygon& written, const std::string& path) {
    if (written.has_file()) return;  // it could not be read, which is said already
    if (!checks_.sound(path) || longer_side_m_ == 0) return;
    const auto flaw = flaw_of(polygon_of(written), least_area_m2(longer_side_m_));
    if (!flaw) return;
    const std::string place = flaw->hole < 0 ? path : indexed(path + ".holes", flaw->hole);
    checks_.problem(place, flaw->what, flaw->remedy);
  }

  const proto::Target& target_;
  Checks& checks_;
  double longer_side_m_ = 0;  // 0 while the domain is invalid
};

}  // namespace

void validate_target(const proto::Scenario& scenario, Checks& checks) {
  TargetValidator(scenario, checks).run();
}

}  // namespace ergocast
