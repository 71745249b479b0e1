// SPDX-License-Identifier: BSD-3-Clause
// Binds the basis and the mission. Coefficients have two indices in a plane, three in a box.
#include "core/mission/mission.h"
#include "core/mission/station.h"
#include "plan/mission_limits.h"
#include "python/arrays.h"
#include "python/module.h"

namespace ergocast::python {
namespace {

using namespace pybind11::literals;

Box make_domain(const Numbers& origin_m, const Numbers& size_m) {
  const Box any{{0, 0, 0}, {1, 1, size_m.size() == 3 ? 1.0 : 0.0}};
  const Box domain{position_in(origin_m, any, "origin_m"), position_in(size_m, any, "size_m")};
  for (int axis = 0; axis < axes_of(any); ++axis) {
    check(limits::kSize_m.contain(domain.size_m[axis]),
          "size_m: each side must be from 1e-3 to 1e7 m");
    check(limits::kCoordinate_m.contain(domain.origin_m[axis]),
          "origin_m: must be from -1e13 to 1e13 m");
  }
  return domain;
}

Basis make_basis(int modes_x, int modes_y, const std::string& form, double exponent,
                 bool normalized, int modes_z) {
  check(limits::kModes.contain(modes_x) && limits::kModes.contain(modes_y) &&
            limits::kModes.contain(modes_z),
        "modes_x, modes_y, modes_z: must be from 1 to " + std::to_string(kMaxModesPerAxis));
  check(form == "squared_norm" || form == "norm",
        "sobolev_form: must be \"squared_norm\" or \"norm\", not \"" + form + "\"");
  Basis basis;
  basis.modes_x = modes_x;
  basis.modes_y = modes_y;
  basis.modes_z = modes_z;
  basis.sobolev_form = form == "norm" ? SobolevForm::kNorm : SobolevForm::kSquaredNorm;
  basis.sobolev_exponent = finite(exponent, "sobolev_exponent");
  basis.normalized = normalized;
  return basis;
}

/// A plane has one mode along z.
void check_fit(const Basis& basis, const Box& domain) {
  check(basis.planar() || !domain.planar(), "modes_z: the domain is a plane");
}

Numbers values(const Basis& basis, const Numbers& x_m, const Box& domain) {
  check_fit(basis, domain);
  const auto places = positions_in(x_m, domain, "x_m");
  std::vector<py::ssize_t> shape = shape_of(basis);
  shape.insert(shape.begin(), static_cast<py::ssize_t>(places.size()));
  Numbers result(shape);
  double* out = result.mutable_data();
  for (const Eigen::Vector3d& place : places) {
    set_basis(CosinesAt(place, domain, basis), basis, 1, out);
    out += basis.mode_count();
  }
  return result;
}

Numbers gradient(const Basis& basis, const Numbers& weights, const Numbers& x_m,
                 const Box& domain) {
  const Coefficients factors = coefficients_in(weights, basis, "weights");
  check_fit(basis, domain);
  const auto places = positions_in(x_m, domain, "x_m");
  Numbers result({static_cast<py::ssize_t>(places.size()), axes_of(domain)});
  double* out = result.mutable_data();
  for (const Eigen::Vector3d& place : places) {
    const BasisAt at(place, domain, basis);
    const Eigen::Vector3d sum = weighted_gradient(at, basis, factors.data());
    out = std::copy_n(sum.data(), axes_of(domain), out);
  }
  return result;
}

double metric(const Numbers& coverage, const Numbers& target, const Basis& basis,
              const Box& domain) {
  return ergodic_metric(coefficients_in(coverage, basis, "coverage"),
                        coefficients_in(target, basis, "target"), sobolev_weights(basis, domain));
}

Numbers starts(const Mission& mission) {
  const py::ssize_t axes = axes_of(mission.domain);
  Numbers result({static_cast<py::ssize_t>(mission.starts_m.size()), axes});
  double* out = result.mutable_data();
  for (const Eigen::Vector3d& start : mission.starts_m) out = std::copy_n(start.data(), axes, out);
  return result;
}

py::list walls(const Mission& mission) {
  py::list rings;
  for (const Ring& ring : mission.walls) {
    Numbers corners({static_cast<py::ssize_t>(ring.size()), py::ssize_t{2}});
    double* out = corners.mutable_data();
    for (const Eigen::Vector2d& corner_m : ring) out = std::copy_n(corner_m.data(), 2, out);
    rings.append(std::move(corners));
  }
  return rings;
}

py::dict stations(const Mission& mission) {
  py::dict places;
  for (int agent = 0; agent < static_cast<int>(mission.starts_m.size()); ++agent) {
    if (const auto station_m = station_of(mission, agent))
      places[py::int_(agent)] = array_of(*station_m, mission.domain);
  }
  return places;
}

py::tuple tuple_of(const Eigen::Vector3d& vector, const Box& domain) {
  return py::tuple(array_of(vector, domain).attr("tolist")());
}

void add_domain(py::module_& module) {
  py::class_<Box>(module, "Domain", R"(A rectangle or box [origin, origin + size] in metres.

Its sides reflect. ValueError for sides outside 1e-3 … 1e7 m.)")
      .def(py::init(&make_domain), "origin_m"_a = py::make_tuple(0.0, 0.0),
           "size_m"_a = py::make_tuple(1.0, 1.0))
      .def_property_readonly(
          "origin_m", [](const Box& d) { return array_of(d.origin_m, d); },
          "Lower left corner, shape (2,), of a box (3,) [m].")
      .def_property_readonly(
          "size_m", [](const Box& d) { return array_of(d.size_m, d); },
          "Its sides, shape (2,), of a box (3,) [m].")
      .def("__repr__", [](const Box& d) {
        return py::str("Domain(origin_m={}, size_m={})")
            .format(tuple_of(d.origin_m, d), tuple_of(d.size_m, d));
      });
}

void add_basis(py::module_& module) {
  py::class_<Basis>(module, "Basis",
                    R"(What coefficients and φ² are in: cosines, or the modes of a free domain.

The cosines (2) are f_mn(x) = cos(mπx/Lx) cos(nπy/Ly), not divided by h_k.

Row m, column n of every array of coefficients belongs to f_mn. In a box with modes_z above 1
there is a factor cos(lπz/Lz), and l is the first of three indices. The weights are
λ = (1 + |k|²)^−s ("squared_norm") or (1 + |k|)^−s ("norm"), divided by h_k² if
the basis is normalised. ValueError for modes outside 1 … 64.

The basis of a mission with basis.free_domain has free_domain True. Its modes have no formula: f are
the modes_x · modes_y lowest of the domain without walls, by ascending ν row by row, each divided by
its greatest value, and λ is as docs/free_domain.md has it. One that is made here is of cosines.)")
      .def(py::init(&make_basis), "modes_x"_a, "modes_y"_a, "sobolev_form"_a = "squared_norm",
           "sobolev_exponent"_a = 1.5, "normalized"_a = py::bool_(false), "modes_z"_a = 1)
      .def_readonly("modes_x", &Basis::modes_x, "Modes along x.")
      .def_readonly("modes_y", &Basis::modes_y, "Modes along y.")
      .def_readonly("modes_z", &Basis::modes_z, "Modes along z; in a plane 1.")
      .def_readonly("free_domain", &Basis::free_domain,
                    "Whether the modes are those of the free domain, not cosines.")
      .def_readonly("sobolev_exponent", &Basis::sobolev_exponent, "s of λ.")
      .def_readonly("normalized", &Basis::normalized, "Whether f is divided by h_k.")
      .def_property_readonly(
          "sobolev_form",
          [](const Basis& b) {
            return b.sobolev_form == SobolevForm::kNorm ? "norm" : "squared_norm";
          },
          "\"squared_norm\" or \"norm\".")
      .def("values", &values, "x_m"_a, "domain"_a,
           "f_mn at each place: x_m has the shape (n, 2) [m], the result (n, modes_x, modes_y).")
      .def("gradient", &gradient, "weights"_a, "x_m"_a, "domain"_a,
           "Σ weights_mn ∇f_mn at each place, (6) for weights λ (c − μ): shape (n, 2) "
           "[unit of weights per metre].")
      .def(
          "weights",
          [](const Basis& b, const Box& domain) { return array_of(sobolev_weights(b, domain), b); },
          "domain"_a, "λ_k, over h_k² if normalised: shape (modes_x, modes_y).");
}

void add_law(py::module_& module) {
  py::class_<ControlLaw>(module, "ControlLaw",
                         "The input (8) and the dynamics (10), as scenario.proto describes them.")
      .def_readonly("u_max_mps", &ControlLaw::u_max_mps, "Bound of the spectral input [m/s].")
      .def_readonly("epsilon", &ControlLaw::epsilon, "ε of (8).")
      .def_readonly("noise_intensity", &ControlLaw::noise_intensity, "σ [m/√s].")
      .def_readonly("noise_ceiling", &ControlLaw::noise_ceiling, "Greatest σ [m/√s].")
      .def_readonly("contraction_gain_per_s", &ControlLaw::contraction_gain_per_s, "k [1/s].")
      .def_readonly("anticipation", &ControlLaw::anticipation, "How far agents look ahead.")
      .def_readonly("memory_half_life_s", &ControlLaw::memory_half_life_s,
                    "Half-life of coverage [s]; 0: nothing is forgotten.");
}

void add_mission(py::module_& module) {
  py::class_<Mission>(module, "Mission", R"(A compiled mission: nothing in it needs checking.

compile_mission() makes it from a scenario; a record has its own.)")
      .def_readonly("name", &Mission::name, "Name of the scenario.")
      .def_readonly("seed", &Mission::seed, "Seed of all random numbers.")
      .def_readonly("domain", &Mission::domain, "The rectangle.")
      .def_readonly("basis", &Mission::basis, "The modes and their weights.")
      .def_readonly("law", &Mission::law, "The control law.")
      .def_property_readonly(
          "mu", [](const Mission& m) { return array_of(m.target_coefficients, m.basis); },
          "μ of the target, (3): shape (modes_x, modes_y); mu[0, 0] is 1.")
      .def_property_readonly("starts_m", &starts, "Where agent i begins: shape (agents, 2) [m].")
      .def_property_readonly(
          "walls_m", &walls,
          "Rings of the walls, each of shape (corners, 2) [m]. A place is solid if "
          "an odd number of rings contains it.")
      .def_property_readonly("stations_m", &stations,
                             "Where each agent that has a station is at the end: shape (2,) [m].")
      .def_property_readonly(
          "dt_s", [](const Mission& m) { return m.timing.dt_s; }, "Control step [s].")
      .def_property_readonly(
          "tick_count", [](const Mission& m) { return m.timing.tick_count; },
          "The mission has the ticks 0 … tick_count − 1.")
      .def_readonly("speed_limit_mps", &Mission::speed_limit_mps,
                    "Limit of vehicles whose kind has none of its own [m/s]; 0: none.");
}

}  // namespace

void add_method(py::module_& module) {
  add_domain(module);
  add_basis(module);
  add_law(module);
  add_mission(module);
  module.def("ergodic_metric", &metric, "coverage"_a, "target"_a, "basis"_a, "domain"_a,
             R"(φ² = Σ λ_k (c_k − μ_k)², over h_k² if the basis is normalised.

coverage, target: c and μ, shape (modes_x, modes_y). ValueError for another shape.)");
}

}  // namespace ergocast::python
