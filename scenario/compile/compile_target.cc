// SPDX-License-Identifier: BSD-3-Clause
// Reads the maps row by row, adds up all parts of the target, and checks what lies inside the
// domain.
#include "scenario/compile/compile_target.h"

#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "scenario/parse/convert.h"
#include "target/geo/gdal_files.h"
#include "target/geo/polygon_file.h"
#include "target/maps/map_file.h"
#include "target/maps/netcdf_grid.h"
#include "target/raster_integral.h"

namespace ergocast {
namespace {

/// Limit (Scenario): share of the target's weight in the domain, at least. Below it: the scenario
/// is refused.
constexpr double kMinMassInside = 1e-6;
/// The maximum error of any μ_mn. Only Gaussians that have correlation or are beside keep-outs come
/// near it, if almost all of their mass is cut off.
/// Limit (Scenario): error of a coefficient μ of the target; only Gaussians that are correlated or
/// beside keep-outs can have more. Beyond it: the scenario is refused.
constexpr double kMaxTargetError = 1e-7;

/// The cells of a picture along the longer side of the domain, as many as a person can distinguish,
/// and the minimum along the shorter side.
constexpr double kMostCells = 256, kFewestCells = 64;

std::string span_text(double origin_m, double size_m) {
  return shortest(origin_m) + " to " + shortest(origin_m + size_m) + " m";
}

std::string text_of(const Rectangle& rectangle) {
  return "x " + span_text(rectangle.origin_m.x(), rectangle.size_m.x()) + ", y " +
         span_text(rectangle.origin_m.y(), rectangle.size_m.y());
}

/// The basis of cosines, also where agents steer by other modes.
Basis cosines_of(const proto::Basis& written) {
  Basis basis = basis_of(written);
  basis.free_domain = false;
  return basis;
}

class TargetCompiler {
 public:
  TargetCompiler(const proto::Scenario& scenario, Checks& checks)
      : written_(scenario.target()),
        origin_{scenario.origin().latitude_deg(), scenario.origin().longitude_deg()},
        checks_(checks),
        domain_(domain_of(scenario.domain())),
        base_m_(domain_.size_m.head<2>()),
        basis_(cosines_of(scenario.basis())),
        target_(target_of(scenario)),
        from_corner_(from_corner(target_, domain_)),
        along_z_(domain_.size_m.z(), basis_),
        storeys_(storeys_of(domain_.size_m.z(), from_corner_.keep_outs)) {
    const Eigen::Vector2d cells =
        (base_m_ / base_m_.maxCoeff() * kMostCells).cwiseMax(kFewestCells);
    maps_.resize(storeys_.size(),
                 DensityGrid::Zero(std::lround(cells.x()), std::lround(cells.y())));
  }

  std::optional<CompiledTarget> run() {
    sum_ = target_integrals(target_, domain_, basis_);
    for (int i = 0; i < written_.regions_size(); ++i) region(i);
    for (int i = 0; i < written_.maps_size(); ++i) {
      map(written_.maps(i), indexed("target.maps", i));
    }
    for (int i = 0; i < written_.voxels_size(); ++i) {
      voxels(written_.voxels(i), indexed("target.voxels", i));
    }
    if (checks_.sound("target")) mass();
    if (!checks_.nothing_found()) return {};
    const DensityGrid picture = density_picture(from_corner_, maps_, domain_.size_m);
    const double scale = base_m_.prod() / sum_.values[0];
    return CompiledTarget{normalized(sum_).values, scale * picture};
  }

 private:
  void region(int index) {
    const Region& region = target_.regions[static_cast<std::size_t>(index)];
    if (free_share(region, target_, domain_) > 0) return;
    checks_.problem(indexed("target.regions", index), "nothing of it is left" + cut_off(),
                    "move it, or remove it");
  }

  void map(const proto::Map& map, const std::string& path) {
    const std::string field = path + ".file";
    OpenedMap opened = map_kind(map.file()) == MapKind::kGeoTiff
                           ? open_geotiff(map.file(), origin_, domain_)
                           : open_map(map.file());
    if (!opened) return refuse(field, opened.error());
    MapFile& file = **opened;
    const Rectangle extent = file.extent() ? *file.extent() : extent_of(map);
    const RasterGrid grid{from_corner(extent, domain_), file.columns(), file.rows()};
    std::vector<RasterIntegral> integrals;
    for (const Storey& storey : storeys_)
      integrals.emplace_back(grid, base_m_, basis_, storey.free(base_m_));
    RasterPicture picture(grid, base_m_, static_cast<int>(maps_[0].rows()),
                          static_cast<int>(maps_[0].cols()));
    std::vector<double> row(static_cast<std::size_t>(grid.columns));
    std::size_t bad_rows = 0;
    for (int i = 0; i < grid.rows && bad_rows < kMostFileProblems; ++i) {
      if (const auto problem = file.next_row(row)) {
        refuse(field, *problem);
        if (!problem->ends_row) return;
        if (++bad_rows == kMostFileProblems && i + 1 < grid.rows)
          checks_.problem(field, map.file() + " may have further problems after these",
                          "repair these rows first");
        continue;
      }
      const int from_south = map.first_row() == proto::Map::SOUTH ? i : grid.rows - 1 - i;
      for (RasterIntegral& integral : integrals) integral.add_row(from_south, row);
      picture.add_row(from_south, row);
    }
    if (bad_rows > 0) return;
    if (!integrals[0].has_mass()) return nothing_in(map.file(), field);
    double left = 0;
    for (std::size_t i = 0; i < storeys_.size(); ++i) {
      const Eigen::VectorXd along_z = profile(map, storeys_[i].heights);
      const PlaneIntegrals shares = integrals[i].shares();
      left += shares.values(0, 0) * along_z[0];
      add_product(map.weight(), shares, along_z, sum_);
      maps_[i] += map.weight() * along_z[0] * picture.density();
    }
    if (!(left > 0)) return nothing_left(path, extent);
    weight_of_maps_ += map.weight();
  }

  void refuse(const std::string& field, const MapProblem& problem) {
    checks_.problem(field, problem.what, problem.remedy);
    for (const MapProblem& other : problem.more) refuse(field, other);
  }

  void voxels(const proto::Voxels& written, const std::string& path) {
    NetcdfChoice choice{written.variable(),
                        std::nullopt,
                        {written.x_axis(), written.y_axis(), written.z_axis(), written.time_axis()},
                        domain_.planar()};
    if (written.has_time_index()) choice.time_index = written.time_index();
    auto opened = NetcdfGrid::open(written.file(), choice);
    if (!opened) return checks_.problem(path, opened.error().what, opened.error().remedy);
    NetcdfGrid& grid = **opened;
    TargetCoefficients sum{Coefficients::Zero(basis_.mode_count()), 0};
    std::vector<DensityGrid> pictures(storeys_.size(), 0 * maps_[0]);
    double whole = 0;
    for (int layer = 0; layer < static_cast<int>(grid.layers().size()); ++layer) {
      if (const auto problem = add_layer(grid, layer, sum, pictures, whole))
        return checks_.problem(path, problem->what, problem->remedy);
    }
    if (!(whole > 0)) {
      return nothing_in(written.file(), path);
    }
    if (!(sum.values[0] > 0)) {
      return checks_.problem(path, "nothing of it is left" + cut_off() + extents_of(grid),
                             "move the domain there");
    }
    const double scale = written.weight() / whole;
    sum_.values += scale * sum.values;
    sum_.error_bound += scale * sum.error_bound;
    for (std::size_t i = 0; i < storeys_.size(); ++i) maps_[i] += scale * pictures[i];
    weight_of_maps_ += written.weight();
  }

  /// Adds the integrals of one layer, and its mass to `whole`.
  std::optional<MapProblem> add_layer(NetcdfGrid& grid, int layer, TargetCoefficients& sum,
                                      std::vector<DensityGrid>& pictures, double& whole) const {
    const Heights heights = above_floor(grid.layers()[static_cast<std::size_t>(layer)], domain_);
    RasterGrid raster = grid.raster();
    raster.extent = from_corner(raster.extent, domain_);
    std::vector<RasterIntegral> integrals;
    for (const Storey& storey : storeys_)
      integrals.emplace_back(raster, base_m_, basis_, storey.free(base_m_));
    RasterPicture picture(raster, base_m_, static_cast<int>(maps_[0].rows()),
                          static_cast<int>(maps_[0].cols()));
    std::vector<double> values(static_cast<std::size_t>(raster.columns));
    for (int row = 0; row < raster.rows; ++row) {
      if (auto problem = grid.row(layer, row, values)) return problem;
      for (RasterIntegral& integral : integrals) integral.add_row(row, values);
      picture.add_row(row, values);
    }
    if (!integrals[0].has_mass()) return std::nullopt;
    const double mass = integrals[0].whole() * heights.length_m();
    for (std::size_t i = 0; i < storeys_.size(); ++i) {
      const Eigen::VectorXd along_z = along_z_.uniform(heights, storeys_[i].heights);
      add_product(mass, integrals[i].shares(), along_z, sum);
      pictures[i] += mass * along_z[0] * picture.density();
    }
    whole += mass;
    return std::nullopt;
  }

  std::string extents_of(const NetcdfGrid& grid) const {
    const Heights low = grid.layers().front(), high = grid.layers().back();
    const auto along_z = [&](double low_m, double size_m) {
      return domain_.planar() ? "" : ", z " + span_text(low_m, size_m);
    };
    return ": its extent is " + text_of(grid.raster().extent) +
           along_z(low.low_m, high.high_m - low.low_m) + ", the domain " +
           text_of(base_of(domain_)) + along_z(domain_.origin_m.z(), domain_.size_m.z());
  }

  void nothing_left(const std::string& path, const Rectangle& extent) {
    checks_.problem(path,
                    "nothing of it is left" + cut_off() + ": its extent is " + text_of(extent) +
                        ", the domain " + text_of(base_of(domain_)),
                    "move its extent over the domain");
  }

  /// The layers of a map along z, with the mass 1 in all.
  Eigen::VectorXd profile(const proto::Map& map, const Heights& within) const {
    if (domain_.planar()) return Eigen::VectorXd::Ones(1);
    double mass = 0;
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(basis_.modes_z);
    for (const proto::Layer& layer : map.layers()) {
      const Heights heights = above_floor({layer.low_z_m(), layer.high_z_m()}, domain_);
      mass += layer.value() * heights.length_m();
      sum += layer.value() * heights.length_m() * along_z_.uniform(heights, within);
    }
    return sum / mass;
  }

  void nothing_in(const std::string& file, const std::string& path) {
    checks_.problem(path, file + " has no number above 0",
                    "write numbers above 0 where something is wanted");
  }

  std::string cut_off() const {
    return std::string(" inside the domain") +
           (target_.keep_outs.empty() ? "" : " and outside the keep-outs");
  }

  void mass() {
    double all = target_.uniform_weight + weight_of_maps_;
    for (const Gaussian& gaussian : target_.gaussians) all += gaussian.weight;
    for (const Region& region : target_.regions) all += region.weight;
    const double left = sum_.values[0] / all;
    if (!(left >= kMinMassInside)) {
      return checks_.problem("target",
                             "only " + shortest(left) + " of its weight is" + cut_off() +
                                 ", below the limit " + shortest(kMinMassInside),
                             "move its parts into the domain, or widen them");
    }
    const double error = normalized(sum_).error_bound;
    if (error <= kMaxTargetError) return;
    checks_.problem("target",
                    "its coefficients can be off by " + shortest(error) + ", more than the limit " +
                        shortest(kMaxTargetError),
                    "use wider or less correlated Gaussians");
  }

  const proto::Target& written_;
  const GeoPlace origin_;
  Checks& checks_;
  const Box domain_;
  const Eigen::Vector2d base_m_;
  const Basis basis_;
  const TargetDensity target_, from_corner_;
  const AlongZ along_z_;
  const std::vector<Storey> storeys_;
  TargetCoefficients sum_;
  std::vector<DensityGrid> maps_;  // in each storey
  double weight_of_maps_ = 0;
};

}  // namespace

std::optional<CompiledTarget> compile_target(const proto::Scenario& scenario, Checks& checks) {
  return TargetCompiler(scenario, checks).run();
}

}  // namespace ergocast
