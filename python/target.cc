// SPDX-License-Identifier: BSD-3-Clause
// Binds target densities, and checks arguments against their preconditions.
#include "target/target.h"

#include <pybind11/stl.h>

#include <cmath>

#include "python/arrays.h"
#include "python/module.h"
#include "scenario/rules/polygon_flaw.h"

namespace ergocast::python {
namespace {

using namespace pybind11::literals;

double weight_in(double weight, const std::string& name) {
  check(std::isfinite(weight) && weight >= 0, name + ": must be finite and at least 0");
  return weight;
}

Eigen::Matrix2d covariance_in(const Numbers& numbers) {
  check(numbers.ndim() == 2 && numbers.shape(0) == 2 && numbers.shape(1) == 2,
        "covariance_m2: the shape must be (2, 2), not " + shape_text(numbers));
  check_finite(numbers, "covariance_m2");
  Eigen::Matrix2d covariance;
  covariance << numbers.at(0, 0), numbers.at(0, 1), numbers.at(1, 0), numbers.at(1, 1);
  check(covariance(0, 1) == covariance(1, 0), "covariance_m2: must be symmetric");
  const double product = covariance(0, 0) * covariance(1, 1);
  check(
      covariance(0, 0) > 0 && covariance(1, 1) > 0 && product > covariance(0, 1) * covariance(0, 1),
      "covariance_m2: must be positive definite");
  return covariance;
}

Gaussian make_gaussian(const Numbers& mean_m, std::optional<double> sigma_m,
                       const std::optional<Numbers>& covariance_m2, double weight) {
  check(sigma_m.has_value() != covariance_m2.has_value(),
        "give sigma_m or covariance_m2, and not both");
  const double checked_weight = weight_in(weight, "weight");
  const Eigen::Vector2d place_m = place_in(mean_m, "mean_m");
  if (covariance_m2) return plane_gaussian(checked_weight, place_m, covariance_in(*covariance_m2));
  check(std::isfinite(*sigma_m) && *sigma_m > 0, "sigma_m: must be finite and above 0");
  return plane_gaussian(checked_weight, place_m, *sigma_m * *sigma_m * Eigen::Matrix2d::Identity());
}

Polygon make_polygon(const Numbers& outline_m, const std::vector<Numbers>& holes_m) {
  Polygon polygon{places_in(outline_m, "outline_m"), {}};
  for (const Numbers& hole : holes_m) polygon.holes.push_back(places_in(hole, "holes_m"));
  Eigen::Vector2d low(HUGE_VAL, HUGE_VAL), high = -low;
  for (const Eigen::Vector2d& corner : polygon.outline) {
    low = low.cwiseMin(corner);
    high = high.cwiseMax(corner);
  }
  const double side_m = polygon.outline.empty() ? 0 : (high - low).maxCoeff();
  if (const auto flaw = flaw_of(polygon, 1e-8 * side_m * side_m)) {
    const std::string where =
        flaw->hole < 0 ? "outline_m" : "holes_m[" + std::to_string(flaw->hole) + "]";
    throw wrong(where + ": " + flaw->what + " (" + flaw->remedy + ")");
  }
  return polygon;
}

Region make_region(const Numbers& outline_m, const std::vector<Numbers>& holes_m, double weight) {
  return {weight_in(weight, "weight"), make_polygon(outline_m, holes_m)};
}

TargetDensity make_target(std::vector<Gaussian> gaussians, double uniform_weight,
                          std::vector<Region> regions, const std::vector<Region>& keep_outs) {
  TargetDensity target{
      std::move(gaussians), weight_in(uniform_weight, "uniform_weight"), std::move(regions), {}};
  for (const Region& region : keep_outs) target.keep_outs.push_back({region.polygon});
  return target;
}

double mass_in(const TargetDensity& target, const Box& domain) {
  check(domain.planar(), "domain: targets made here are those of a plane");
  const double mass = mass_inside(target, domain);
  check(mass > 0, "the target has no mass inside the domain and outside its keep-outs");
  return mass;
}

py::tuple coefficients(const TargetDensity& target, const Box& domain, const Basis& basis) {
  TargetCoefficients result;
  {
    const py::gil_scoped_release others_may_run;
    mass_in(target, domain);
    result = target_coefficients(target, domain, basis);
  }
  return py::make_tuple(array_of(result.values, basis), result.error_bound);
}

Numbers density(const TargetDensity& target, const Numbers& x_m, const Box& domain) {
  const double mass = mass_in(target, domain);
  const auto places = places_in(x_m, "x_m");
  Numbers result(static_cast<py::ssize_t>(places.size()));
  double* out = result.mutable_data();
  for (const Eigen::Vector2d& place : places) {
    const Eigen::Vector3d x = on_ground(place);
    *out++ = domain.contains(x) ? density_unscaled(target, domain, x) / mass : 0;
  }
  return result;
}

}  // namespace

void add_target(py::module_& module) {
  py::class_<Gaussian>(module, "Gaussian",
                       R"(One Gaussian of the mixture (7), weight · N(mean, covariance).

mean_m has the shape (2,) [m]; give sigma_m [m] or covariance_m2, shape (2, 2) [m²].
ValueError for a negative weight or a covariance that is not positive definite.)")
      .def(py::init(&make_gaussian), "mean_m"_a, "sigma_m"_a = py::none(),
           "covariance_m2"_a = py::none(), "weight"_a = 1.0);
  py::class_<Region>(
      module, "Region",
      R"(A polygon with a constant density and the mass `weight`; of a keep-out the polygon alone counts.

outline_m and each of holes_m: corners in order, shape (n, 2) [m]. ValueError for a
polygon that crosses itself, or has no area.)")
      .def(py::init(&make_region), "outline_m"_a, "holes_m"_a = std::vector<Numbers>{},
           "weight"_a = 1.0);
  py::class_<TargetDensity>(
      module, "Target",
      R"(A target density ρ: a sum of parts, 0 in every keep-out and outside the domain.

It is divided by the remaining mass, so that it integrates to 1.)")
      .def(py::init(&make_target), "gaussians"_a = std::vector<Gaussian>{},
           "uniform_weight"_a = 0.0, "regions"_a = std::vector<Region>{},
           "keep_outs"_a = std::vector<Region>{})
      .def("coefficients", &coefficients, "domain"_a, "basis"_a,
           R"(μ_mn = ∫ f_mn ρ, (3), shape (modes_x, modes_y), and how far any entry may be off.

ValueError if no mass is left inside the domain.)")
      .def("density", &density, "x_m"_a, "domain"_a,
           "ρ at each place: x_m has the shape (n, 2) [m], the result (n,) [1/m²].");
}

}  // namespace ergocast::python
