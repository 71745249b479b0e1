// SPDX-License-Identifier: BSD-3-Clause
// Checks Gaussians, regions, keep-outs and maps one by one, each under its own path.
#include "scenario/rules/validate_target.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "scenario/parse/convert.h"
#include "scenario/rules/polygon_flaw.h"
#include "target/maps/map_file.h"

namespace ergocast {
namespace {

/// Limit (Scenario): standard deviations, `Gaussian.sigma_m`, `Gaussian.sigma_z_m` [times the
/// domain's longest side]. Beyond it: the scenario is refused.
constexpr Range kSigmaPerSide = limits::between(1e-4, 1e4);
/// Limit (Scenario): Gaussians, `Target.gaussians`. Beyond it: the scenario is refused.
constexpr int kMaxGaussians = 64;
/// Limit (Scenario): maps, `Target.maps`, and grids, `Target.voxels`. Beyond it: the scenario is
/// refused.
constexpr int kMaxMaps = 16;
/// Limit (Scenario): regions, `Target.regions`. Beyond it: the scenario is refused.
constexpr int kMaxRegions = 64;
/// Limit (Scenario): keep-outs, `Target.keep_outs`. Beyond it: the scenario is refused.
constexpr int kMaxKeepOuts = 64;
/// Above this the ridge is too narrow for the quadrature of μ.
/// Limit (Scenario): size of a covariance, `Covariance.xy_m2`, `Covariance.xz_m2`,
/// `Covariance.yz_m2` [times the root of the product of both variances]. Beyond it: the scenario is
/// refused.
constexpr double kMaxCorrelation = 0.99;
/// The least eigenvalue of a Gaussian in a box, scaled to deviations of 1, for the same reason.
/// Limit (Scenario): eigenvalues of a covariance with deviations of 1, at least. Below it: the
/// scenario is refused.
constexpr double kLeastEigenvalue = 1 - kMaxCorrelation;
/// Limit (Scenario): layers of a map, `Map.layers`. Beyond it: the scenario is refused.
constexpr int kMaxLayers = 256;
constexpr double kLeastHeightPerDomain = 1e-8;

class TargetValidator {
 public:
  TargetValidator(const proto::Scenario& scenario, Checks& checks)
      : target_(scenario.target()), has_origin_(scenario.has_origin()), checks_(checks) {
    if (!checks.sound("domain")) return;
    domain_ = domain_of(scenario.domain());
    longer_side_m_ = domain_.size_m.maxCoeff();
  }

  void run() {
    at_most("Gaussians", target_.gaussians_size(), kMaxGaussians);
    at_most("maps", target_.maps_size(), kMaxMaps);
    at_most("regions", target_.regions_size(), kMaxRegions);
    at_most("keep-outs", target_.keep_outs_size(), kMaxKeepOuts);
    for (int i = 0; i < target_.gaussians_size(); ++i) {
      width(target_.gaussians(i), indexed("target.gaussians", i));
    }
    at_most("grids", target_.voxels_size(), kMaxMaps);
    for (int i = 0; i < target_.maps_size(); ++i) map(target_.maps(i), indexed("target.maps", i));
    for (int i = 0; i < target_.voxels_size(); ++i)
      voxels(target_.voxels(i), indexed("target.voxels", i));
    polygons();
    if (target_.gaussians_size() == 0 && target_.uniform_weight() == 0 &&
        target_.maps_size() == 0 && target_.regions_size() == 0 && target_.voxels_size() == 0) {
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
    if (gaussian.has_sigma_m()) {
      deviation(path + ".sigma_m", gaussian.sigma_m());
      if (gaussian.has_sigma_z_m() && gaussian.sigma_z_m() != gaussian.sigma_m())
        deviation(path + ".sigma_z_m", gaussian.sigma_z_m());
      return;
    }
    if (gaussian.has_sigma_z_m() && checks_.sound(path + ".sigma_z_m")) {
      return checks_.problem(path + ".sigma_z_m", "has no effect with covariance",
                             "remove it, and write zz_m2 in the covariance");
    }
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
    if (!covary(c.xy_m2(), c.xx_m2(), c.yy_m2(), path, "xx_m2 yy_m2")) return;
    if (c.has_zz_m2()) {
      if (!covary(c.xz_m2(), c.xx_m2(), c.zz_m2(), path, "xx_m2 zz_m2")) return;
      if (!covary(c.yz_m2(), c.yy_m2(), c.zz_m2(), path, "yy_m2 zz_m2")) return;
      if (!definite(c, path)) return;
    }
    if (longer_side_m_ == 0) return;
    variance(path + ".xx_m2", c.xx_m2());
    variance(path + ".yy_m2", c.yy_m2());
    if (c.has_zz_m2()) variance(path + ".zz_m2", c.zz_m2());
  }

  /// Whether two coordinates with these variances may have this covariance.
  bool covary(double covariance_m2, double one_m2, double other_m2, const std::string& path,
              const std::string& variances) {
    const double limit_m2 = kMaxCorrelation * std::sqrt(one_m2) * std::sqrt(other_m2);
    if (std::abs(covariance_m2) <= limit_m2) return true;
    checks_.problem(
        path + '.' + variances.substr(0, 1) + variances.substr(6, 1) + "_m2",
        shortest(covariance_m2) + " leaves too little for the covariance to be positive " +
            "definite: the limit is " + shortest(kMaxCorrelation) + " sqrt(" + variances + ")",
        "write " + shortest(-rounded_down(limit_m2)) + " to " + shortest(rounded_down(limit_m2)));
    return false;
  }

  /// Three pairs may each be valid, and still not fit together.
  bool definite(const proto::Covariance& c, const std::string& path) {
    const Eigen::Vector3d deviation_m =
        Eigen::Vector3d(c.xx_m2(), c.yy_m2(), c.zz_m2()).cwiseSqrt();
    Eigen::Matrix3d correlation = Eigen::Matrix3d::Identity();
    const auto set = [&](int i, int j, double covariance_m2) {
      correlation(i, j) = correlation(j, i) = covariance_m2 / (deviation_m[i] * deviation_m[j]);
    };
    set(0, 1, c.xy_m2());
    set(0, 2, c.xz_m2());
    set(1, 2, c.yz_m2());
    const double least =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(correlation, Eigen::EigenvaluesOnly)
            .eigenvalues()[0];
    // The eigenvalue of one pair at its limit, with a margin for rounding.
    if (least >= kLeastEigenvalue - 1e-12) return true;
    checks_.problem(
        path,
        "is not positive definite enough: with deviations of 1 its least eigenvalue is " +
            shortest(rounded_down(least)) + ", below the limit " +
            shortest(rounded_down(kLeastEigenvalue)),
        "write smaller xy_m2, xz_m2 or yz_m2");
    return false;
  }

  void variance(const std::string& path, double variance_m2) {
    const double low_m = kSigmaPerSide.low * longer_side_m_;
    const double high_m = kSigmaPerSide.high * longer_side_m_;
    checks_.in_range(path, variance_m2, limits::between(low_m * low_m, high_m * high_m));
  }

  // Maps.

  static std::string remedy_for(const std::string& file) {
    if (file.ends_with(".nc"))
      return "write it as voxels { file: \"" + file + "\" variable: \"…\" }";
    return "write the map as one of these: convert in out.png, or gdal_translate in out.tif";
  }

  void map(const proto::Map& map, const std::string& path) {
    if (!map.has_file() || map.file().empty()) {
      return checks_.missing(path + ".file", "is missing",
                             "add the name of a .png, .pgm, .csv, .asc, .tif or .yaml");
    }
    layers(map, path);
    const std::optional<MapKind> kind = map_kind(map.file());
    if (!kind) {
      return checks_.problem(path + ".file",
                             map.file() + " does not end in .png, .pgm, .csv, .asc, .tif or .yaml",
                             remedy_for(map.file()));
    }
    const bool states = states_extent(*kind);
    extent(path + ".origin_x_m", map.has_origin_x_m(), states);
    extent(path + ".origin_y_m", map.has_origin_y_m(), states);
    extent(path + ".size_x_m", map.has_size_x_m(), states);
    extent(path + ".size_y_m", map.has_size_y_m(), states);
    if (states && map.first_row() == proto::Map::SOUTH) {
      checks_.problem(path + ".first_row", "this kind of map always begins in the north",
                      "remove it");
    }
    if (*kind == MapKind::kGeoTiff && !has_origin_) {
      checks_.problem(path + ".file",
                      "a GeoTIFF needs to know where on the earth the scenario lies",
                      "write origin { latitude_deg: … longitude_deg: … }");
    }
  }

  void voxels(const proto::Voxels& grid, const std::string& path) {
    if (!grid.has_file() || grid.file().empty()) {
      checks_.missing(path + ".file", "is missing", "add the name of a .nc");
    } else if (!grid.file().ends_with(".nc")) {
      checks_.problem(path + ".file", grid.file() + " does not end in .nc",
                      "write the grid as NetCDF");
    }
    if (!grid.has_variable() || grid.variable().empty())
      checks_.missing(path + ".variable", "is missing", "add the name of a variable of the file");
  }

  /// @pre the defaults are filled in: in a box with limits there is one
  void layers(const proto::Map& map, const std::string& path) {
    if (map.layers_size() > 0 && domain_.planar() && longer_side_m_ > 0)
      return checks_.of_a_box_alone(indexed(path + ".layers", 0));
    if (map.layers_size() > kMaxLayers) {
      return checks_.problem(path,
                             std::to_string(map.layers_size()) + " layers are above the limit " +
                                 std::to_string(kMaxLayers),
                             "join the thinnest");
    }
    bool some = map.layers_size() == 0;
    for (int i = 0; i < map.layers_size(); ++i) {
      const proto::Layer& layer = map.layers(i);
      const std::string here = indexed(path + ".layers", i);
      some = some || layer.value() > 0;
      if (!heights(layer, here)) return;
      for (int j = 0; j < i; ++j) {
        if (layer.low_z_m() >= map.layers(j).high_z_m() ||
            layer.high_z_m() <= map.layers(j).low_z_m())
          continue;
        return checks_.problem(here, "overlaps " + indexed("layers", j), "let one begin above it");
      }
    }
    if (!some)
      checks_.problem(path, "no layer has a value above 0", "write one where something is wanted");
  }

  /// Whether a prism or layer has an extent along z, some of it in the domain.
  bool heights(const auto& part, const std::string& path) {
    if (domain_.planar() || !checks_.sound(path)) return false;
    const Heights all = heights_of(domain_);
    if (!(part.high_z_m() - part.low_z_m() >= kLeastHeightPerDomain * all.length_m())) {
      checks_.problem(path,
                      "its heights " + shortest(part.low_z_m()) + " to " +
                          shortest(part.high_z_m()) + " m enclose nothing",
                      "write a greater high_z_m");
      return false;
    }
    if (part.low_z_m() < all.high_m && part.high_z_m() > all.low_m) return true;
    checks_.problem(path,
                    "its heights " + shortest(part.low_z_m()) + " to " + shortest(part.high_z_m()) +
                        " m are outside the domain",
                    "write some of " + shortest(all.low_m) + " to " + shortest(all.high_m));
    return false;
  }

  void extent(const std::string& path, bool present, bool stated_by_file) {
    if (present && stated_by_file) {
      checks_.problem(path, "this kind of map states its own extent", "remove it");
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
    if (written.has_file()) return;  // it could not be read, which is already reported
    if (!checks_.sound(path) || longer_side_m_ == 0) return;
    const auto flaw = flaw_of(polygon_of(written), least_area_m2(longer_side_m_));
    if (!flaw) {
      heights(written, path);
      return;
    }
    const std::string place = flaw->hole < 0 ? path : indexed(path + ".holes", flaw->hole);
    checks_.problem(place, flaw->what, flaw->remedy);
  }

  const proto::Target& target_;
  const bool has_origin_;
  Checks& checks_;
  Box domain_;                // a plane while it is invalid
  double longer_side_m_ = 0;  // 0 while the domain is invalid
};

}  // namespace

void validate_target(const proto::Scenario& scenario, Checks& checks) {
  TargetValidator(scenario, checks).run();
}

}  // namespace ergocast
